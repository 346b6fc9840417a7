#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// What counts as a return. Times, states and distances in the system's scales.
struct NearReturnOptions {
  double time = 0.0;         ///< length of the trajectory
  double period_from = 0.0;  ///< of the orbits that are guessed
  double period_to = 0.0;
  double tolerance = 0.1;  ///< greatest distance
};

/// A trajectory comes near to the image, under a symmetry, of where it was: z(begin + time) is near M z(begin). An
/// orbit that closes so has the period order x time, M being of that order.
struct NearReturn {
  std::size_t begin = 0;      ///< its time in steps of the samples
  std::vector<double> state;  ///< z(begin)
  double time = 0.0;
  int symmetry = 0;  ///< M: the element of loop::SymmetryGroup::of_space with this number; 0: none
  int order = 1;
  double distance = 0.0;  ///< |z(begin + time) - M z(begin)|, angles modulo whole turns
};

/// The returns of the trajectory from `state` that are nearer than the tolerance and than those just before and after
/// them, in the order of begin, symmetry and time. Only symmetries that keep the direction of time return a trajectory.
/// Found on samples of it (Taylor series) whose field turns little from one to the next; the time to the next one is
/// interpolated. Deterministic. Throws core::InputError where the trajectory ends before `time`, or would take more
/// than `most_pairs` pairs of samples; MisuseError for a system without formulas.
[[nodiscard]] std::vector<NearReturn> near_returns(const systems::System& system, const std::vector<double>& state,
                                                   const NearReturnOptions& options);

/// The scales, powers of two, of the trajectory through `state`, in the system's units: a coordinate's is how far it
/// strays from its mean, rms, and the time's how long it takes for that. Coordinates that do not move, and angles, have
/// 1; those that a symmetry mixes have one. Where equilibria say nothing of a system's scales, this does. Throws as
/// `near_returns`.
[[nodiscard]] systems::Scales trajectory_scales(const systems::System& system, const std::vector<double>& state,
                                                const NearReturnOptions& options);

/// Pairs of samples that are compared: some minutes.
inline constexpr double most_pairs = 2e10;

}  // namespace orbweaver::starts
