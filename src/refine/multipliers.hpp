#pragma once

#include <vector>

#include "orbweaver/numerics/extended.hpp"

namespace orbweaver::refine {

/// One real multiplier, or that of a complex pair that lies above the real axis.
struct ExtendedMultiplier {
  numerics::Extended real;
  numerics::Extended imaginary;  ///< 0: real
};

/// The eigenvalues of M(T) but for the trivial one, which is the nearest to 1; the largest modulus first.
/// `determinant`: of M(T). With many digits of it, the least eigenvalue, where that is real, is what the others leave
/// of it: of the matrix it would have the digits of the largest entry.
[[nodiscard]] std::vector<ExtendedMultiplier> nontrivial_multipliers(const numerics::ExtendedMatrix& monodromy,
                                                                     const numerics::Extended& determinant);

}  // namespace orbweaver::refine
