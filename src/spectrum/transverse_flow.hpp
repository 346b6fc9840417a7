#pragma once

#include <Eigen/Dense>

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// The linearised flow on what is left after the directions of the flow and of the conserved energy: the kernel of dH
/// modulo f (without conserved energy: everything modulo f), in an orthonormal basis at each t_m.
struct TransverseFlow {
  Eigen::MatrixXd factors;  ///< segment by segment (matrix_table.hpp); the last one ends with g^-1, in the first basis
  Eigen::MatrixXd errors;   ///< the chain's truncation estimates in the same bases; empty if it has none
  Eigen::MatrixXd around;   ///< g^p in the first basis
  /// In four dimensions with a conserved energy: +1 or -1, the orientation of the first basis behind f and the gradient
  /// of the energy. 0 otherwise.
  double orientation = 0.0;
  Eigen::MatrixXd bases;  ///< there too: 8 x (segments + 1), the basis at each t_m, vector by vector. Empty otherwise

  [[nodiscard]] Eigen::Index dimension() const { return around.rows(); }
};

/// Throws core::NumericalError if f vanishes at one of the chain's states. A team divides the segments among its
/// members.
[[nodiscard]] TransverseFlow transverse_flow(const systems::System& system, const Chain& chain,
                                             const FundamentalGroup& group, core::Team* team = nullptr);

/// The orthonormal basis at t_m in which the factors are written, one vector a column.
[[nodiscard]] Eigen::MatrixXd transverse_basis(const systems::System& system, const Chain& chain, Eigen::Index m);

}  // namespace orbweaver::spectrum
