#pragma once

#include <vector>

#include "orbweaver/equations/collocation.hpp"

namespace orbweaver::equations {

/// The direction of the family through the orbit `u`: the solution of the linearised equations that the first condition
/// of `equations`, or the one with the number `condition`, sees as 1 and the others as 0. Builds the preconditioner at
/// `u`. Throws NumericalError where it does not converge.
[[nodiscard]] std::vector<double> family_direction(Collocation& equations, const std::vector<double>& u,
                                                   int condition = 0);

}  // namespace orbweaver::equations
