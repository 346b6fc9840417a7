#include "locus_task.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "executor.hpp"
#include "interrupted.hpp"
#include "orbweaver/bifurcation/locus.hpp"
#include "orbweaver/continuation/locus_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::survey {

namespace {

int limit_of(continuation::EndReason reason) {
  switch (reason) {
    case continuation::EndReason::period_limit: return period_limited;
    case continuation::EndReason::energy_limit: return energy_limited;
    case continuation::EndReason::parameter_limit: return parameter_limited;
    case continuation::EndReason::step_limit: return step_limited;
    default: return 0;
  }
}

LocusPointRecord record_of(const systems::System& surface, const loop::Loop& loop, const loop::Isotropy& isotropy) {
  LocusPointRecord record;
  record.period = loop.period;
  record.energy = continuation::energy_of(surface, loop);
  if (loop.parameters.size() > 1) record.parameter = loop.parameters.front();
  record.second = loop.parameters.back() * surface.scales().parameter(loop.parameters.size() - 1);
  record.state = loop::state_at(loop::in_standard_phase(surface.structure(), loop, isotropy), 0.0);
  return record;
}

}  // namespace

std::shared_ptr<const systems::System> surface_of(const scene::SystemChoice& choice, const systems::System& system,
                                                  const scene::Loci& loci) {
  scene::SystemChoice with_second = choice;
  with_second.moving.free.push_back(loci.free);
  systems::Scales scales = system.scales();
  const std::size_t others = choice.moving.free.size();
  while (scales.parameters.size() < others) scales.parameters.push_back(1.0);
  // As of the first parameter: the power of two at or below what it is at most.
  double largest = std::abs(system.parameters().at(loci.free));
  for (const double end : {loci.from, loci.to})
    if (std::isfinite(end)) largest = std::max(largest, std::abs(end));
  scales.parameters.push_back(largest > 0.0 ? std::exp2(std::floor(std::log2(largest))) : 1.0);
  return systems::scaled(scene::bound_system(with_second), scales);
}

queue::TaskOutcome follow_locus(const scene::Scene& scene, const systems::System& system, const LocusWork& work,
                                queue::TaskContext& context, core::Team* team) {
  const scene::Loci& loci = scene.loci.at(static_cast<std::size_t>(work.entry));
  const std::shared_ptr<const systems::System> surface = surface_of(scene.system, system, loci);
  const double scale = surface->scales().parameter(surface->family_scalars().free.size() - 1);
  const loop::Isotropy isotropy = loop::with_declared_matrices(work.isotropy, surface->structure());
  continuation::LocusOptions options;
  options.branch = branch_options(scene, team);
  options.from = loci.from / scale;
  options.to = loci.to / scale;
  options.before_each = [&context] {
    if (!context.report({})) throw Interrupted();
  };
  loop::Loop start = work.orbit;
  start.parameters.push_back(surface->parameters().at(loci.free) / scale);
  const continuation::LocusTest test = bifurcation::locus_test(*surface, isotropy, work.event, team);
  LocusOutcome outcome{work.crossing, work.entry, loci.free, work.kind, work.event, work.fundamental_order, {}, 0};
  LocusPointRecord first = record_of(*surface, start, isotropy);
  first.note = "start";
  std::string failure;
  try {
    for (const int side : {-1, 1}) {
      const continuation::Locus locus =
          continuation::follow_locus(surface, isotropy, start, work.tangent, test, side, options);
      std::vector<LocusPointRecord> points;
      for (const continuation::LocusPoint& point : locus.points) {
        LocusPointRecord& record = points.emplace_back(record_of(*surface, point.loop, isotropy));
        record.step = side * static_cast<int>(points.size());
        record.arclength = side * point.arclength;
        record.is_return = point.is_return;
        if (point.is_cusp) record.note = "cusp";
        if (point.is_return) record.note = "return";
      }
      LocusPointRecord& last = points.empty() ? first : points.back();
      last.note += (last.note.empty() ? "" : "; ") + locus.ending.text();
      outcome.limited_by |= limit_of(locus.ending.reason);
      if (locus.ending.failed()) failure = locus.ending.text();
      if (side < 0) std::reverse(points.begin(), points.end());
      if (side > 0) outcome.points.push_back(first);
      outcome.points.insert(outcome.points.end(), points.begin(), points.end());
      if (locus.ending.reason == continuation::EndReason::closed_loop) {
        if (side < 0) outcome.points.push_back(first);
        break;
      }
    }
  } catch (const Interrupted&) {
    return {};
  }
  queue::TaskOutcome done;
  done.payload = pack(outcome);
  done.failed = !failure.empty();
  done.reason = failure;
  return done;
}

}  // namespace orbweaver::survey
