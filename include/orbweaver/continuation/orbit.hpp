#pragma once

#include <limits>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// One accepted orbit of a family with what was measured on it.
struct Orbit {
  loop::Loop loop;
  int step = 0;            ///< 0 for the first orbit of the branch
  double arclength = 0.0;  ///< from the first orbit: sum of sqrt(mean |dz|^2 + (dT/T)^2)
  double energy = 0.0;
  double action = 0.0;  ///< closed integral of p dq
  double loss_rms = 0.0;
  double tail = 0.0;
  /// Where rounding keeps sqrt(loss) above the tolerance: the tolerance that it meets; else 0.
  double tolerance_met = 0.0;
  /// Of a branch's first orbit, where rounding hides those as near as asked for: how many times as far from the start
  /// it was taken; else 0.
  double moved_out = 0.0;
  int iterations = 0;
  /// Of the step that led here: how often it has to be halved for pieces as long as steps that the branch chooses.
  int halvings = 0;
  double off_branch_eigenvalue = std::numeric_limits<double>::quiet_NaN();

  static constexpr int wire_version = 4;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, loop, step, arclength, energy, action, loss_rms, tail, tolerance_met, moved_out,
                            iterations, halvings, off_branch_eigenvalue);
  }
};

/// The first conserved quantity at a loop's state at s = 0; NaN for systems without one.
[[nodiscard]] double energy_of(const systems::System& system, const loop::Loop& loop);

/// What tells the orbits of one family in T apart beside T: the energy, or the parameter that moves. In the system's
/// scales.
[[nodiscard]] double level_of(const systems::System& system, const loop::Loop& loop);

/// Action over one period: T times the mean over time of p . dq/dt, on the loss's nodes (spectrally accurate).
[[nodiscard]] double action_of(const systems::System& system, const loop::Loop& loop);

/// sqrt(mean |dz|^2 + (dT/T)^2 + |dp|^2) between neighbours, p being the parameters that move.
[[nodiscard]] double arclength_between(const loop::Loop& from, const loop::Loop& to);

/// The same between any two orbits that wind alike, wherever they begin: the least over the time shifts of one.
[[nodiscard]] double distance_between_orbits(const systems::System& system, const loop::Loop& from,
                                             const loop::Loop& to);

/// Distance of two computations of one orbit, relative to 1 + rms amplitude of the loop. The first orbits of twins, the
/// nearest families that were compared, are 0.01 apart (docs/mathematics.md, "Identity").
inline constexpr double same_orbit_tolerance = 1e-6;

/// How far apart two computations of one orbit may be: `tolerance` of 1 + the rms amplitude, wherever the origin lies;
/// where the coordinates leave fewer digits than that, what rounding of them is allowed.
[[nodiscard]] double same_within(const loop::Loop& loop, double tolerance = same_orbit_tolerance);

/// sqrt(mean |dz|^2 + (dT/T)^2 + |dp|^2) in the units of the scene, for loops told in the system's scales: the
/// archive's arclength.
[[nodiscard]] double arclength_in_units(const systems::System& system, const loop::Loop& from, const loop::Loop& to);

}  // namespace orbweaver::continuation
