#include "start_task.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "executor.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/way_from_start.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::survey {

namespace {

/// Amplitudes to try, in parts of the first. Too large a one may find another family, too small a one is lost in
/// rounding. Not measured; a factor decides only where the ones before it found no orbit.
constexpr double amplitude_factors[] = {1.0, 0.3, 3.0, 0.1, 10.0, 0.03};
/// Of the size of the orbit at the crossing: what a nearer one differs by in energy and index, the square of this, is
/// not much more than rounding.
constexpr double nearest = 1e-4;
/// Least cosine between the first orbit's way and the direction in which it was to leave (60 degrees): an orbit of
/// another direction lies beside it. Not measured.
constexpr double least_share = 0.5;

}  // namespace

queue::TaskOutcome start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                         const StartWork& work, core::Team* team) {
  const continuation::Start begin = start_of(work.branch, system->structure());
  continuation::Options options = branch_options(scene, team);
  const double least = nearest * loop::rms_amplitude(begin.base);
  const double first = std::max(least, work.branch.amplitude > 0.0 ? work.branch.amplitude : options.start_amplitude);
  std::optional<std::string> why;
  StartOutcome outcome;
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
    const continuation::WayFromStart way = continuation::way_from(begin, orbit->loop);
    if (way.share < least_share || way.is_along_base()) {
      why = fmt::format(
          "at amplitude {:.2g} the orbit found lies beside the direction (cosine {:.2f}, of the whole way {:.2f})",
          options.start_amplitude, way.share, way.share_of_whole);
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
