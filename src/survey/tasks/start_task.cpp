#include "start_task.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "executor.hpp"
#include "orbweaver/continuation/branch.hpp"

namespace orbweaver::survey {

namespace {

/// Amplitudes to try, in parts of the first. Too large a one may find another family, too small a one is lost in
/// rounding. Not measured; a factor decides only where the ones before it found no orbit.
constexpr double amplitude_factors[] = {1.0, 0.3, 3.0, 0.1, 10.0, 0.03};
/// Least cosine between the first orbit's way and the direction in which it was to leave (60 degrees): an orbit of the
/// base family or of another direction lies beside it. Not measured.
constexpr double least_share = 0.5;
/// Two ways are as much aside where their cosines differ by less than this part, one orbit being nearer by so much.
constexpr double same_share = 0.1;
constexpr double nearer = 0.6;
/// 84 degrees: what lies farther aside is told from the base family by rounding and curvature no more. Not measured.
constexpr double least_share_of_straight = 0.1;

/// What of the orbit's way from the crossing lies along the direction in which it was to leave.
struct WayAlong {
  double along = 0.0;
  double share = 0.0;  ///< of the whole way
};
WayAlong way_along(const continuation::Start& start, const loop::Loop& orbit) {
  const int cutoff = std::min(start.base.cutoff, orbit.cutoff);
  const loop::Loop even = orbit.time_map.is_identity() ? orbit : loop::evenly_in_time(orbit);
  const loop::Loop there = loop::with_cutoff(even, cutoff);
  const loop::Loop base = loop::with_cutoff(start.base, cutoff);
  double along = 0.0;
  double length = 0.0;
  double moved = 0.0;
  for (std::size_t n = 0; n < there.modes.size(); ++n) {
    const double step = there.modes[n] - base.modes[n];
    along += step * start.direction.modes[n];
    length += start.direction.modes[n] * start.direction.modes[n];
    moved += step * step;
  }
  return {along / std::sqrt(length), moved > 0.0 ? along / std::sqrt(length * moved) : 0.0};
}

/// Whether a way lies as much aside as one farther out. A family that goes through a crossing of order 3 has a part of
/// the base's own direction; one that passes beside the crossing would be as far at half the amplitude.
bool is_straight(const WayAlong& way, const WayAlong& farther) {
  return way.share > least_share_of_straight && way.along < nearer * farther.along &&
         std::abs(way.share - farther.share) < same_share * farther.share;
}

}  // namespace

queue::TaskOutcome start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                         const StartWork& work, core::Team* team) {
  const continuation::Start begin = start_of(work.branch, system->structure());
  continuation::Options options = branch_options(scene, team);
  const double first = work.branch.amplitude > 0.0 ? work.branch.amplitude : options.start_amplitude;
  std::optional<std::string> why;
  StartOutcome outcome;
  WayAlong farther;               // of an orbit beside the direction
  bool is_beyond_limits = false;  // the first of these amplitudes that leads to an orbit
  for (const double factor : amplitude_factors) {
    if (is_beyond_limits && factor > 1.0) continue;
    options.start_amplitude = factor * first;
    continuation::Branch branch(system, begin, options);
    const std::optional<continuation::Orbit> orbit = branch.advance();
    if (!orbit) {
      const continuation::Ending ending = branch.ending().value();
      if (!ending.failed()) outcome.limited_by = orbit_limited;
      if (ending.failed() || why) {  // a limit reached from further out says nothing of this family
        if (!why) why = ending.text();
      } else {
        is_beyond_limits = true;  // unless a nearer orbit lies within them
      }
      continue;
    }
    const WayAlong way = way_along(begin, orbit->loop);
    if (way.share < least_share && !is_straight(way, farther)) {
      why = fmt::format("at amplitude {:.2g} the orbit found lies beside the direction (cosine {:.2f})",
                        options.start_amplitude, way.share);
      farther = way;
      continue;
    }
    BranchWork found = work.branch;
    found.amplitude = options.start_amplitude;
    queue::TaskOutcome done;
    done.children.push_back(task_of(found));
    done.payload = pack(outcome);
    return done;
  }
  if (is_beyond_limits) {  // no family begins
    queue::TaskOutcome done;
    done.payload = pack(outcome);
    return done;
  }
  queue::TaskOutcome failed;
  failed.failed = true;
  failed.reason = fmt::format("no orbit leaves along this direction: {}", why.value_or(""));
  return failed;
}

}  // namespace orbweaver::survey
