#include "branch_task.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/branch/requested.hpp"
#include "tasks/certified.hpp"
#include "tasks/equilibrium_end.hpp"
#include "tasks/orbit_row.hpp"
#include "tasks/section_rows.hpp"

namespace orbweaver::survey {

namespace {

/// Of an index from 2, where a branch may be on the way to a crossing that rounding hides. Only then is it looked for.
/// Not measured.
constexpr double nearly_two = 1e-4;

continuation::Options options_of(const scene::Scene& scene, const BranchWork& work, core::Team* team) {
  continuation::Options options = branch_options(scene, team);
  if (work.amplitude > 0.0) options.start_amplitude = work.amplitude;
  return options;
}

}  // namespace

BranchTask::BranchTask(const scene::Scene& scene, std::shared_ptr<const systems::System> system, BranchWork work,
                       const std::string& state, const GivenOrbitWatch& given, archive::Records& rows,
                       queue::TaskContext& context, core::Team* team, PayloadStore* store)
    : _followed(scene, std::move(system), std::move(work), team),
      _given(given),
      _rows(rows),
      _context(context),
      _store(store),
      _options(options_of(scene, _followed.work, team)),
      _symmetry(_followed.system->structure(), _followed.start.isotropy),
      _first_orbit(_followed),
      _events(_followed, store),
      _ends(_followed, _events, _symmetry) {
  if (is_certified_by_branches(scene)) {
    certificate::Options options;
    options.level = certificate_level(scene);
    _certifier.emplace(*_followed.system, _followed.start.isotropy, options);
  }
  _may_arrive_ahead = _followed.system->structure().symplectic &&
                      std::none_of(_followed.start.isotropy.begin(), _followed.start.isotropy.end(),
                                   [](const loop::SymmetryElement& e) { return e.reversing; });
  if (_followed.work.lineage.crossing.empty() && scene.compute.stability)
    _options.too_far = [this](const auto& first) { return _first_orbit.is_too_far(first); };
  const bool is_without_pairs =
      !_followed.system->structure().conservative() && !_followed.system->family_scalars().free.empty();
  if ((_followed.system->structure().symplectic || is_without_pairs) && scene.compute.stability)
    _options.jumped = [this](const auto& from, const auto& to) { return jumped(from, to); };
  begin(state);
}

void BranchTask::begin(const std::string& bytes) {
  if (bytes.empty()) {
    _branch.emplace(_followed.system, _followed.start, _options);
    return;
  }
  BranchState state = unpack_branch_state(bytes);
  _branch.emplace(_followed.system, _followed.start, _options, std::move(state.frontier));
  for (const continuation::FamilyCurve::Known& known : state.known) _followed.curve.add(known, kept_orbits);
  _events.go_on(std::move(state.detector), state.folds, state.events, state.passed_one, std::move(state.children));
  _sampled = bifurcation::SymmetryWatch::sampled(state.last.loop);
  _followed.last = std::move(state.last);
  _followed.outcome = std::move(state.outcome);
}

BranchState BranchTask::state_at(const continuation::Frontier& frontier) const {
  return {frontier,        _followed.curve.known(), _events.detector_state(), _events.folds(), _followed.last.value(),
          _events.count(), _events.passed_one(),    _followed.outcome,        _events.tasks()};
}

queue::TaskOutcome BranchTask::run() {
  continuation::Ending ending;
  try {
    ending = follow();
    if (!_stopped) finish();
  } catch (const std::exception& error) {  // here, not in the queue, so that the summary still counts the orbits kept
    ending = {continuation::EndReason::failure, core::recordable(error.what())};
    if (_followed.outcome.limited_by == 0)
      _followed.outcome.limited_by = orbit_limited;  // from its start: where it stands is not known
  }
  _followed.outcome.end = ending;
  if (_followed.outcome.tolerance_met > 0.0)
    _followed.outcome.remarks.push_back(
        fmt::format("the tolerance {:.2g} is below what rounding allows here: {:.2g} met",
                    _followed.scene.continuation.tolerance, _followed.outcome.tolerance_met));
  if (_followed.outcome.moved_out > 0.0)
    _followed.outcome.remarks.push_back(fmt::format(
        "a first orbit at continuation.start would be lost in rounding: it is taken {:.2g} times as far out",
        _followed.outcome.moved_out));
  queue::TaskOutcome done;
  done.failed = ending.failed();
  done.reason = ending.failed() ? ending.text() : "";
  done.children = _events.take_tasks();
  done.payload = pack(_followed.outcome);
  return done;
}

continuation::Ending BranchTask::follow() {
  while (true) {
    const continuation::Frontier before = _branch->restart_frontier();
    const std::optional<continuation::Orbit> orbit = _branch->advance();
    if (!orbit) {
      continuation::Ending ending = _branch->ending().value();
      if (ending.failed() && _followed.last && arrives_ahead()) return met();
      if (ending.failed() && _followed.last) decide(ending);
      note_limits(ending, before);
      if (ending.reason == continuation::EndReason::fixed_point) {
        const EquilibriumEnd end = equilibrium_end(_followed.scene, *_followed.system, _followed.last->loop);
        _followed.outcome.equilibrium = end.index;
        _given.arrive(_followed.work.lineage, _followed.last->loop, _followed.outcome.passed);
        ending.detail = fmt::format("{}; {}", end.text, ending.detail);
      }
      return ending;
    }
    // The branch ends with an orbit on a limit, which it would not have under a wider one: no state may hold it.
    const continuation::Frontier& there = _branch->restart_frontier();
    const bool on_limit = orbit->loop.period >= _options.period_limit || there.on_energy_limit ||
                          there.on_parameter_limit || there.on_guard_limit >= 0;
    if (on_limit || _branch->met_limit()) limited_by(orbit_limited, before);
    const double period = orbit->loop.period * units().time;
    if (const auto lost = lost_in_rounding(*orbit)) {
      note_limits(*lost, before);
      return *lost;
    }
    if (!take(*orbit)) return met();
    if (on_limit) continue;
    const double level = continuation::level_of(*_followed.system, orbit->loop) * units().level();
    _stopped = !_context.report({_followed.outcome.orbits, 1, {period, level, orbit->loop.cutoff * 1.0}},
                                [&] { return pack(state_at(_branch->restart_frontier())); });
    if (_stopped) return {continuation::EndReason::stopped, fmt::format("T = {:.9g}", period)};
  }
}

/// Where rounding hides what the indices pass it may hide on which side of its neighbour an orbit lies, too: the branch
/// would go to and fro.
std::optional<continuation::Ending> BranchTask::lost_in_rounding(const continuation::Orbit& orbit) {
  if (!_followed.last || !_options.jumped) return std::nullopt;
  const std::optional<spectrum::Stability>& stability = _followed.stability_at(orbit);
  if (!stability || bifurcation::are_decided(*stability)) return std::nullopt;
  const std::string why =
      nearer_than_rounding(*_followed.system, orbit.loop, _followed.last->loop, _followed.start.isotropy);
  if (why.empty()) return std::nullopt;
  return continuation::Ending{continuation::EndReason::undecided, why};
}

/// Where its last orbits are not told apart a branch may fail for no other reason.
void BranchTask::decide(continuation::Ending& ending) const {
  const std::vector<continuation::FamilyCurve::Known>& known = _followed.curve.known();
  const loop::Loop* before = known.size() > 1 ? &known[known.size() - 2].loop : nullptr;
  const std::string why =
      not_told_apart(*_followed.system, _followed.last->loop, before, _followed.start.isotropy, _followed.team);
  if (why.empty()) return;
  ending.reason = continuation::EndReason::undecided;
  ending.detail = why + "; " + ending.detail;
}

continuation::Ending BranchTask::met() const {
  return {continuation::EndReason::stopped,
          fmt::format("T = {:.9g}", _followed.outcome.arrival.front().period * units().time)};
}

void BranchTask::note_limits(const continuation::Ending& ending, const continuation::Frontier& before) {
  using continuation::EndReason;
  switch (ending.reason) {
    case EndReason::step_limit: return limited_by(step_limited, before);
    case EndReason::period_limit:
    case EndReason::energy_limit:
    case EndReason::parameter_limit:
    case EndReason::guard_limit:
    // On the way to an orbit on a limit, perhaps.
    case EndReason::cutoff_limit:
    case EndReason::period_divergence:
    case EndReason::collision:
    case EndReason::undecided:
    case EndReason::failure: return limited_by(orbit_limited, before);
    default: return;
  }
}

/// The first limit counts: orbits behind it may depend on it.
void BranchTask::limited_by(int limits, const continuation::Frontier& before) {
  if (_followed.outcome.limited_by == 0 && _followed.last) {
    BranchState state = state_at(before);
    state.children.clear();  // of a branch that has ended they are tasks of their own (else see reopen.cpp)
    _followed.outcome.before_limit = pack(state);
    if (_store != nullptr) _store->keep(_followed.outcome.before_limit);
  }
  _followed.outcome.limited_by |= limits;
}

/// What only the family's end shows, from the stored orbits alone, whatever was probed before.
void BranchTask::finish() {
  if (_followed.curve.known().size() < orbits_from_birth) _ends.look_before_first(_arrival);
  for (const continuation::Orbit& orbit : _ends.look_behind_last(_arrival))
    store(orbit, _followed.asked_stability(orbit.loop));
  _followed.curve.forget_found();
  _events.finish_zeros();
}

/// False where the branch has arrived at another family.
bool BranchTask::take(const continuation::Orbit& orbit) {
  if (!_followed.last)
    _followed.outcome.before_first =
        _followed.work.lineage.crossing.empty()
            ? 0.0
            : continuation::arclength_in_units(*_followed.system, _followed.start.base, orbit.loop);
  _followed.curve.add(orbit.arclength, orbit.loop, kept_orbits);
  if (_followed.outcome.orbits > 0 && _followed.curve.known().size() == orbits_from_birth)
    _ends.look_before_first(_arrival);
  if (arrive(orbit)) return false;
  if (!_followed.last && _options.too_far && !(_followed.work.amplitude > 0.0) && !_followed.work.base_is_orbit)
    _events.watch_from_rest(orbit);
  const std::optional<spectrum::Stability>& stability = _followed.stability_at(orbit);
  if (_followed.last && _last_stability && stability)
    _events.detect_meetings({_followed.last->arclength, *_last_stability}, {orbit.arclength, *stability});
  _events.detect(orbit, stability);
  if (_followed.last) {
    solve_requested(orbit);
    _given.watch(_followed.work.lineage, _followed.start.isotropy, *_followed.last, orbit, _followed.outcome.passed);
  }
  const bool is_other_sides = _followed.work.base_is_orbit && _followed.work.lineage.side < 0 && !_followed.last;
  if (!is_other_sides) store(orbit, stability);
  _followed.last = orbit;
  _stability_before = std::exchange(_last_stability, stability);
  return !(stability && is_nearly_two(*stability) && arrives_ahead());
}

/// Whether an index is so near to 2 that the orbit hardly has a place of its own.
bool BranchTask::is_nearly_two(const spectrum::Stability& stability) {
  return std::any_of(stability.full.begin(), stability.full.end(),
                     [](const std::complex<double>& k) { return std::abs(k - 2.0) < nearly_two; });
}

bool BranchTask::arrives_ahead() {
  if (!_may_arrive_ahead || _followed.curve.known().size() < 2) return false;
  const auto ahead = arrival_ahead(_followed.system, _followed.curve, _symmetry);
  if (ahead) _followed.outcome.arrival.push_back(*ahead);
  return ahead.has_value();
}

bool BranchTask::jumped(const continuation::Orbit& from, const continuation::Orbit& to) {
  const auto known = [&](std::optional<spectrum::Stability>& stability, const loop::Loop& loop) {  // not after a break
    if (!stability) stability = stability_of(*_followed.system, loop, _followed.start.isotropy, _followed.team);
    return stability && bifurcation::are_decided(*stability);
  };
  if (!known(_last_stability, _followed.last->loop)) return false;
  const std::optional<spectrum::Stability>& after = _followed.stability_at(to);
  if (!after || !bifurcation::are_decided(*after)) return false;
  bifurcation::KnownStability last{from, *_last_stability};
  const auto& orbits = _followed.curve.known();
  if (orbits.size() > 1)
    if (const auto& before = orbits[orbits.size() - 2]; known(_stability_before, before.loop))
      last.slope = bifurcation::slope_to_two(_followed.system->structure(), *_stability_before, *_last_stability,
                                             orbits.back().position - before.position);
  const core::LogEvent event(core::Event::validation);
  return bifurcation::has_jumped(_followed.system, _followed.start.isotropy,
                                 branch_options(_followed.scene, _followed.team), last, {to, *after});
}

bool BranchTask::arrive(const continuation::Orbit& orbit) {
  bifurcation::SymmetryWatch::SampledOrbit sampled = bifurcation::SymmetryWatch::sampled(orbit.loop);
  if (_followed.last) {
    const core::LogEvent event(core::Event::validation);
    if (auto arrival = arrival_between(*_followed.system, _followed.curve, _symmetry, *_followed.last, *_sampled, orbit,
                                       sampled)) {
      // The met family looks only for crossings of the orders that the scene asks for.
      if (arrival->record.multiplicity > _followed.scene.survey.subharmonics)
        (void)(locate_beneath(_followed.system, _followed.curve.options(), arrival->near, arrival->record) ||
               locate_beneath(_followed.system, _followed.curve.options(), _followed.last->loop, arrival->record));
      _followed.outcome.arrival.push_back(arrival->record);
      _arrival = std::move(*arrival);
    }
  }
  _sampled = std::move(sampled);
  return !_followed.outcome.arrival.empty();
}

void BranchTask::solve_requested(const continuation::Orbit& orbit) {
  for (continuation::Orbit& wanted : requested_orbits(_followed.scene, *_followed.system, _followed.curve,
                                                      *_followed.last, orbit, _followed.outcome.remarks))
    store(wanted, _followed.asked_stability(wanted.loop));
}

void BranchTask::store(continuation::Orbit orbit, const std::optional<spectrum::Stability>& stability) {
  const bool first = _followed.outcome.orbits == 0;
  const double period = orbit.loop.period * units().time;
  const double level = continuation::level_of(*_followed.system, orbit.loop) * units().level();
  _followed.outcome.period_from = first ? period : std::min(_followed.outcome.period_from, period);
  _followed.outcome.period_to = first ? period : std::max(_followed.outcome.period_to, period);
  _followed.outcome.level_from = first ? level : std::min(_followed.outcome.level_from, level);
  _followed.outcome.level_to = first ? level : std::max(_followed.outcome.level_to, level);
  _followed.outcome.last_period = period;
  _followed.outcome.last_level = level;
  _followed.outcome.last_cutoff = orbit.loop.cutoff;
  _followed.outcome.tolerance_met = std::max(_followed.outcome.tolerance_met, orbit.tolerance_met);
  _followed.outcome.moved_out = std::max(_followed.outcome.moved_out, orbit.moved_out);
  // The other side of a crossing: counted backwards from it.
  orbit.step = _followed.work.lineage.side > 0 ? _followed.outcome.orbits : -1 - _followed.outcome.orbits;
  orbit.arclength = signed_arclength(_followed.work.lineage, _followed.outcome.before_first,
                                     _followed.curve.arclength_at(orbit.arclength));
  const loop::Loop stored =
      loop::in_standard_phase(_followed.system->structure(), orbit.loop, _followed.start.isotropy);
  _rows.orbits.push_back(orbit_row(*_followed.system, _followed.work.lineage.family, orbit, stored, stability,
                                   _certifier ? &*_certifier : nullptr));
  for (archive::SectionRecord& row :
       section_rows(_followed.scene.section, *_followed.system, stored, _followed.work.lineage.family, orbit.step))
    _rows.sections.push_back(std::move(row));
  ++_followed.outcome.orbits;
}

}  // namespace orbweaver::survey
