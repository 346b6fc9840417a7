#pragma once

#include <optional>
#include <string>

#include "orbweaver/continuation/branch.hpp"

/// When a branch ends, from where it stands (docs/mathematics.md, "Ends"). `units` are those of its numbers, which
/// texts tell in the units of the scene.
namespace orbweaver::continuation {

/// Growth of T over which the energy is compared where the period may diverge: a tenth, which near a saddle multiplies
/// the distance from the connecting orbit by exp(-rate T/10). Not measured; it decides only how an end is called.
inline constexpr double period_window = 1.1;

/// The end that the last orbit is; none if the branch goes on.
[[nodiscard]] std::optional<Ending> end_at(const Frontier& frontier, const Options& options,
                                           const systems::Scales& units = {});

/// The end where the first orbit lies beyond the scene's limits already; none if it does not.
[[nodiscard]] std::optional<Ending> beyond_limits(double period, double energy, const Options& options,
                                                  const systems::Scales& units = {});

/// An end for want of harmonics, or by failure; of a settled family it is a divergence of the period.
[[nodiscard]] Ending end_between(const Frontier& frontier, EndReason reason, std::string detail,
                                 const systems::Scales& units = {});

}  // namespace orbweaver::continuation
