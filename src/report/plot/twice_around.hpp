#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The smallest eigenvalue of the Hessian at each orbit of a family gone around twice, over perturbations that once
/// around changes the sign of (odd harmonics of the doubled loop): it goes to zero where a family of twice the period
/// leaves. As `off_branch_eigenvalue` in the survey's scales and the unscaled coefficients of the loop with s even in
/// time; NaN where it does not converge. Computed anew.
[[nodiscard]] std::vector<double> eigenvalues_twice_around(const archive::Archive& atlas, std::size_t family);

}  // namespace orbweaver::report
