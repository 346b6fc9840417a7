#pragma once

#include <vector>

#include "continuation/families.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/spectrum/loop_triplets.hpp"

namespace orbweaver::test {

/// In-phase crossings of the ideal double pendulum (the numbers).
inline constexpr double in_phase_doubling = 8.442930704977588;
inline constexpr double in_phase_branching = 10.416773281973249;

inline continuation::Orbit measured(const loop::Loop& loop) {
  continuation::Orbit orbit;
  orbit.loop = loop;
  orbit.energy = continuation::energy_of(*pendulum(), loop);
  orbit.action = continuation::action_of(*pendulum(), loop);
  return orbit;
}

/// The in-phase orbit of this period, under the identity as time map.
inline loop::Loop even_in_phase_orbit(double period) {
  return orbit_at(even_family_to_twelve(in_phase()), period).loop;
}

/// The flat direction of a loop among the perturbations of a subspace at fixed period; the time shift is left out.
inline loop::Tangent kernel_of(const loop::Loop& loop, const loop::Subspace& subspace) {
  const loss::Unknowns unknowns{subspace, {}};
  const std::vector<double> shift = unknowns.time_shift_direction(loop);
  const Eigen::VectorXd direction =
      Eigen::Map<const Eigen::VectorXd>(shift.data(), static_cast<Eigen::Index>(shift.size()));
  const bool has_shift = direction.norm() > 1e-8;
  const Eigen::MatrixXd conditions =
      has_shift ? Eigen::MatrixXd(direction.normalized()) : Eigen::MatrixXd(direction.size(), 0);
  spectrum::TripletOptions options;
  options.krylov_from = 100000;
  const spectrum::SingularTriplets found = spectrum::smallest_singular_triplets(
      *pendulum(), loop, unknowns, loss::Slice(unknowns.size(), conditions), options);
  loop::Tangent kernel;
  kernel.modes.assign(loop.modes.size(), 0.0);
  kernel.scalars = {0.0};
  subspace.add_to(std::span<const double>(found.right.data(), static_cast<std::size_t>(found.right.rows())),
                  kernel.modes);
  return kernel;
}

/// The first orbits of a branch on either side of its crossing, in its own order: those on the side of -direction
/// first.
struct Branching {
  loop::Isotropy isotropy;
  loop::Loop crossing;
  std::vector<continuation::Orbit> before;  ///< nearest to the crossing last
  std::vector<continuation::Orbit> after;   ///< nearest first
};

inline Branching both_sides(const loop::Loop& crossing, const loop::Tangent& kernel, const loop::Isotropy& isotropy) {
  Branching out{isotropy, crossing, {}, {}};
  continuation::Options options;
  options.step_limit = 6;
  options.start_amplitude = 0.02;
  continuation::Start start{crossing, kernel, isotropy};
  out.after = trace_of(pendulum(), start, options).orbits;
  start.direction *= -1.0;
  out.before = trace_of(pendulum(), start, options).orbits;
  std::reverse(out.before.begin(), out.before.end());
  return out;
}

/// IB: keeps S@1/2 and loses the reversors.
inline const Branching& in_phase_branch() {
  static const Branching branch = [] {
    const loop::Loop crossing = even_in_phase_orbit(in_phase_branching);
    const loop::Isotropy isotropy = pendulum_isotropy(*pendulum());
    const std::vector<int> signs{1, -1};
    return both_sides(crossing, kernel_of(crossing, loop::Subspace(4, crossing.cutoff, isotropy, signs)),
                      {isotropy.front()});
  }();
  return branch;
}

/// ID1's brake orbits: twice around, R@0 alone.
inline const Branching& in_phase_double() {
  static const Branching branch = [] {
    const loop::Loop crossing = loop::repeated(even_in_phase_orbit(in_phase_doubling), 2);
    const loop::Isotropy isotropy{pendulum_isotropy(*pendulum()).back()};
    return both_sides(crossing, kernel_of(crossing, loop::Subspace(4, crossing.cutoff, isotropy)), isotropy);
  }();
  return branch;
}

}  // namespace orbweaver::test
