#pragma once

#include <vector>

#include "orbweaver/equations/preconditioned_equations.hpp"

namespace orbweaver::equations {

/// Brings a far guess `u` (in place) near a solution: Newton's steps, with a new factor each, halved until the next
/// one, with the same factor, is shorter (the natural monotonicity test; P. Deuflhard, Newton Methods for Nonlinear
/// Problems, 2004, section 3.3). Ends where a whole step is short, and where no part of one leads on: then `u` is the
/// best that was found. Entries of `u` from `scaled_from` on count `scale` times in a step's length. Throws what
/// `equations` throws.
void approach(PreconditionedEquations& equations, std::vector<double>& u, int scaled_from, double scale);

}  // namespace orbweaver::equations
