#pragma once

#include <optional>
#include <string>

#include "orbweaver/continuation/branch.hpp"
#include "point_problem.hpp"

/// When a branch ends, from where it stands (docs/mathematics.md, "Ends"). `units` are those of its numbers, which
/// texts tell in the units of the scene.
namespace orbweaver::continuation {

/// What a family that runs into a divergence of its period settles in: the energy, or the parameter that moves.
[[nodiscard]] double level_of(const systems::System& system, const Orbit& orbit);

/// Growth of T over which the energy is compared where the period may diverge: a tenth, which near a saddle multiplies
/// the distance from the connecting orbit by exp(-rate T/10). Not measured; it decides only how an end is called.
inline constexpr double period_window = 1.1;

/// Smallest values that a trace keeps of a guard, besides the last: over five steps a family that collides falls
/// clearly (docs/mathematics.md, "Ends").
inline constexpr std::size_t earlier_guards = 5;

/// A cheap look: whether the branch's next orbit may lie within `reach` of its first one, all around a circle. Neither
/// T nor the amplitude nor a parameter can be further apart than the loops are.
[[nodiscard]] bool may_have_come_back(const Frontier& frontier, const Trial& trial, double reach);

/// Another, dearer: whether no time shift of the first orbit lies on the step to `loop`, or less than this part of the
/// step's length beside it. `step`: its squared length, a mean over s.
[[nodiscard]] bool is_far_off(const systems::Structure& structure, const loop::Loop& first, const loop::Loop& loop,
                              double beside, double step);

/// The end that the last orbit is; none if the branch goes on. `scalars_at`: in the values of the frontier's points.
[[nodiscard]] std::optional<Ending> end_at(const Frontier& frontier, std::size_t scalars_at,
                                           const systems::System& system, const Options& options);

/// The end where the first orbit lies beyond the scene's limits already; none if it does not.
[[nodiscard]] std::optional<Ending> beyond_limits(const systems::System& system, const loop::Loop& first, double period,
                                                  const Options& options);

/// Whether the first parameter that moves is beyond the scene's limits by more than rounding.
[[nodiscard]] bool is_beyond_parameters(double value, const Options& options);

/// An end for want of harmonics, or by failure: a divergence of the period where the family has settled, a collision
/// where it comes ever nearer to a zero of a guard.
[[nodiscard]] Ending end_between(const Frontier& frontier, const systems::System& system, EndReason reason,
                                 std::string detail);

/// Number of the guard in the structure. Throws MisuseError unless it is there.
[[nodiscard]] int guard_number(const systems::Structure& structure, const std::string& name);

}  // namespace orbweaver::continuation
