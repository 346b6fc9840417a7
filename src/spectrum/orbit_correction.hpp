#pragma once

#include <Eigen/Dense>

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// One Newton step of multiple shooting from a loop to the orbit near it.
struct OrbitCorrection {
  Eigen::MatrixXd states;  ///< dimension x (segments + 1): change of the state at each t_m
  double stretch = 0.0;    ///< relative change of the segments' lengths
};

/// The least correction, without shift of phase. Conservative systems: at almost the same period (a change counts a
/// thousandfold), and the equation that the conserved energy makes redundant left out. By orthogonal elimination from
/// one group of segments to the next (Wright, Stable parallel algorithms for two-point boundary value problems, 1992),
/// stable for any growth around the orbit.
[[nodiscard]] OrbitCorrection orbit_correction(const Chain& chain, const FundamentalGroup& group, bool conservative);

/// The chain along the loop with `factor` times the correction added, to first order in that and second order in h. A
/// team divides the segments among its members.
[[nodiscard]] Chain corrected(const systems::System& system, const Chain& chain, const OrbitCorrection& correction,
                              double factor, core::Team* team = nullptr);

}  // namespace orbweaver::spectrum
