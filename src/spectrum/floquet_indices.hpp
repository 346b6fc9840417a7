#pragma once

#include <complex>
#include <limits>
#include <vector>

#include "orbweaver/systems/structure.hpp"
#include "transverse_flow.hpp"

namespace orbweaver::spectrum {

/// Stability indices (symplectic) or multipliers of the transverse flow.
struct FloquetIndices {
  std::vector<std::complex<double>> full;                   ///< of the whole period
  std::vector<std::complex<double>> fundamental;            ///< of the fundamental map
  double twist = std::numeric_limits<double>::quiet_NaN();  ///< as in Stability
};

/// True where g^p is plus or minus the unit map of a plane: the index is a trace, the full one its Chebyshev
/// polynomial.
[[nodiscard]] bool is_single_pair(const systems::Structure& system, const TransverseFlow& flow);

/// The trace for a single pair, orthogonal iteration otherwise.
[[nodiscard]] FloquetIndices floquet_indices(const systems::Structure& system, const TransverseFlow& flow, int order);

/// Bound on the full index's error if the fundamental one's (of modulus |k|) is `error`.
[[nodiscard]] double repeated_index_error(double k, double error, int order);

}  // namespace orbweaver::spectrum
