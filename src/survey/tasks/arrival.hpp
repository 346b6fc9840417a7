#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// A meeting with a family of more symmetry.
struct Arrival {
  ArrivalRecord record;
  bifurcation::SymmetryGain gain;  ///< what is gained there
  double position = 0.0;           ///< of the meeting along the branch, nearly
  loop::Loop near;                 ///< the orbit before it that its period and energy were extrapolated from
  /// Orbits of the branch, with its directions, from its last one before the meeting, ever nearer to that. Empty where
  /// the last one has no direction.
  std::vector<continuation::CurvePoint> places;
};

/// Where the branch meets a family with more symmetry between two of its orbits, if it does. Beyond that point lie the
/// images of the orbits before it, or, where the broken part is not turned by the symmetry, the other side of a
/// crossing.
[[nodiscard]] std::optional<Arrival> arrival_between(const systems::System& system, continuation::FamilyCurve& family,
                                                     const bifurcation::SymmetryWatch& watch,
                                                     const continuation::Orbit& from,
                                                     const bifurcation::SymmetryWatch::SampledOrbit& from_sampled,
                                                     const continuation::Orbit& to,
                                                     const bifurcation::SymmetryWatch::SampledOrbit& to_sampled);

/// Locates the crossing that the branch meets, as often around as it goes, near `last`, the branch's last orbit, and
/// takes period and energy from there. False, and nothing changes, where `last` does not lie beside such a crossing.
bool locate_beneath(const std::shared_ptr<const systems::System>& system, const continuation::Options& options,
                    const loop::Loop& last, ArrivalRecord& arrival);

/// Where the branch is about to meet a family at a resonance of order 5 or more, if its last known orbit lies beside
/// such a crossing, and nearer than the first. Close to such a crossing rounding decides in which direction an orbit
/// lies from it, so that no branch goes all the way, unless a reversor holds the direction.
[[nodiscard]] std::optional<ArrivalRecord> arrival_ahead(const std::shared_ptr<const systems::System>& system,
                                                         const continuation::FamilyCurve& family,
                                                         const bifurcation::SymmetryWatch& watch);

/// What of a loop (even in time) does not repeat `times` times a period: rms over time.
[[nodiscard]] double not_repeated(const loop::Loop& loop, int times);

/// A loop with few harmonics and s even in time, for comparisons.
[[nodiscard]] loop::Loop sketch_of(const loop::Loop& loop, int cutoff = 60);

}  // namespace orbweaver::survey
