#include "branch_task.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "arrival.hpp"
#include "certified.hpp"
#include "end_folds.hpp"
#include "equilibrium_end.hpp"
#include "executor.hpp"
#include "fold_pairs.hpp"
#include "foldable.hpp"
#include "orbit_row.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "requested.hpp"
#include "section_rows.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

namespace {

/// Known orbits that a location gets along: the two around the event and their neighbours.
constexpr std::size_t kept_orbits = 5;

/// First orbits from which, with the one where the family is born, those in between are predicted: a cubic.
constexpr std::size_t orbits_from_birth = 3;

/// Places from a family's second orbit to its birth at which slopes tell folds, from the first orbit on each so much
/// nearer to the birth than the one before: the last is a thousandth of the first orbit's way from it.
constexpr std::size_t places_from_birth = 7;
constexpr double nearer_to_birth = 0.25;

/// Test functions of a family's birth that are smaller vanish there, the family's own for one. Their error bounds say
/// nothing: they take a Newton step, and the orbits of two families lie side by side. The crossing is located to 1e-9.
constexpr double zero_at_birth = 1e-6;

/// Of an index from 2, where a branch may be on the way to a crossing that rounding hides. Only then is it looked for.
/// Not measured.
constexpr double nearly_two = 1e-4;

/// Length of an oscillation's modes at which it has the indices of the linear motion to a part of 1e-10, and rounding
/// leaves as much.
constexpr double nearly_at_rest = 1e-5;
/// Between an equilibrium and the first orbit a test function changes with the square of the amplitude. Of its larger
/// modulus, but 0.1 at least: where it changes by more, the fourth power may give it zeros in pairs. Not measured.
constexpr double largest_change = 0.1;
/// And turns of the multiplier (Stability::turns), which tell where functions have come back to what they were.
constexpr double most_turned = 0.25;
/// Relative to the equilibrium's: a period or an energy that is asked for and is no further from it is its own.
constexpr double at_equilibrium = 1e-10;

continuation::Options options_of(const scene::Scene& scene, const BranchWork& work, core::Team* team) {
  continuation::Options options = branch_options(scene, team);
  if (work.amplitude > 0.0) options.start_amplitude = work.amplitude;
  return options;
}

/// None where the scene asks for no multipliers.
std::vector<bifurcation::TestFunction> functions_of(const scene::Scene& scene, const systems::System& system,
                                                    const loop::Isotropy& isotropy) {
  if (!scene.compute.stability) return {};
  return bifurcation::test_functions(system.structure(), loop::SymmetryGroup(system.structure(), isotropy).order(),
                                     scene.survey.subharmonics);
}

}  // namespace

BranchTask::BranchTask(const scene::Scene& scene, std::shared_ptr<const systems::System> system, BranchWork work,
                       const std::string& state, const GivenOrbitWatch& given, archive::Records& rows,
                       queue::TaskContext& context, core::Team* team, PayloadStore* store)
    : _scene(scene),
      _system(std::move(system)),
      _work(std::move(work)),
      _given(given),
      _rows(rows),
      _context(context),
      _team(team),
      _store(store),
      _options(options_of(scene, _work, team)),
      _start(start_of(_work, _system->structure())),
      _curve(_system, _start.isotropy, branch_options(scene, team)),
      _symmetry(_system->structure(), _start.isotropy),
      _functions(functions_of(scene, *_system, _start.isotropy)) {
  _outcome.key = _work.key;
  if (is_certified_by_branches(scene)) {
    certificate::Options options;
    options.level = certificate_level(scene);
    _certifier.emplace(*_system, _start.isotropy, options);
  }
  _may_arrive_ahead =
      _system->structure().symplectic && std::none_of(_start.isotropy.begin(), _start.isotropy.end(),
                                                      [](const loop::SymmetryElement& e) { return e.reversing; });
  if (_work.lineage.crossing.empty() && scene.compute.stability)
    _options.too_far = [this](const auto& first) { return is_too_far(first); };
  if (_system->structure().symplectic && scene.compute.stability)
    _options.jumped = [this](const auto& from, const auto& to) { return jumped(from, to); };
  begin(state);
}

void BranchTask::begin(const std::string& bytes) {
  if (bytes.empty()) {
    _branch.emplace(_system, _start, _options);
    return;
  }
  BranchState state = unpack_branch_state(bytes);
  _branch.emplace(_system, _start, _options, std::move(state.frontier));
  for (const continuation::FamilyCurve::Known& known : state.known) _curve.add(known, kept_orbits);
  _detector = bifurcation::Detector(std::move(state.detector), {});
  _folds = state.folds;
  _sampled = bifurcation::SymmetryWatch::sampled(state.last.loop);
  _last = std::move(state.last);
  _before_first = state.before_first;
  _events = state.events;
  _outcome = std::move(state.outcome);
  _children = std::move(state.children);
}

BranchState BranchTask::state_at(const continuation::Frontier& frontier) const {
  return {frontier,      _curve.known(), _detector.state(), _folds,   _last.value(),
          _before_first, _events,        _outcome,          _children};
}

queue::TaskOutcome BranchTask::run() {
  continuation::Ending ending;
  try {
    ending = follow();
    if (!_stopped) finish();
  } catch (const std::exception& error) {  // here, not in the queue, so that the summary still counts the orbits kept
    ending = {continuation::EndReason::failure, error.what()};
    if (_outcome.limited_by == 0) _outcome.limited_by = orbit_limited;  // from its start: where it stands is not known
  }
  _outcome.end = ending;
  if (_outcome.tolerance_met > 0.0)
    _outcome.remarks.push_back(fmt::format("the tolerance {:.2g} is below what rounding allows here: {:.2g} met",
                                           _scene.continuation.tolerance, _outcome.tolerance_met));
  if (_outcome.moved_out > 0.0)
    _outcome.remarks.push_back(fmt::format(
        "a first orbit at continuation.start would be lost in rounding: it is taken {:.2g} times as far out",
        _outcome.moved_out));
  queue::TaskOutcome done;
  done.failed = ending.failed();
  done.reason = ending.failed() ? ending.text() : "";
  done.children = std::move(_children);
  done.payload = pack(_outcome);
  return done;
}

continuation::Ending BranchTask::follow() {
  while (true) {
    const continuation::Frontier before = _branch->restart_frontier();
    const std::optional<continuation::Orbit> orbit = _branch->advance();
    if (!orbit) {
      continuation::Ending ending = _branch->ending().value();
      if (ending.failed() && _last && arrives_ahead()) return met();
      if (ending.failed() && _last) decide(ending);
      note_limits(ending, before);
      if (ending.reason == continuation::EndReason::fixed_point) {
        const EquilibriumEnd end = equilibrium_end(_scene, *_system, _last->loop);
        _outcome.equilibrium = end.index;
        _given.arrive(_work.lineage, _last->loop, _outcome.passed);
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
    if (!take(*orbit)) return met();
    if (on_limit) continue;
    const double level = continuation::level_of(*_system, orbit->loop) * units().level();
    _stopped = !_context.report({_outcome.orbits, 1, {period, level, orbit->loop.cutoff * 1.0}},
                                [&] { return pack(state_at(_branch->restart_frontier())); });
    if (_stopped) return {continuation::EndReason::stopped, fmt::format("T = {:.9g}", period)};
  }
}

/// Where its last orbits are not told apart a branch may fail for no other reason.
void BranchTask::decide(continuation::Ending& ending) const {
  const std::vector<continuation::FamilyCurve::Known>& known = _curve.known();
  const loop::Loop* before = known.size() > 1 ? &known[known.size() - 2].loop : nullptr;
  const std::string why = not_told_apart(*_system, _last->loop, before, _start.isotropy, _team);
  if (why.empty()) return;
  ending.reason = continuation::EndReason::undecided;
  ending.detail = why + "; " + ending.detail;
}

continuation::Ending BranchTask::met() const {
  return {continuation::EndReason::stopped, fmt::format("T = {:.9g}", _outcome.arrival.front().period * units().time)};
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
  if (_outcome.limited_by == 0 && _last) {
    BranchState state = state_at(before);
    state.children.clear();  // of a branch that has ended they are tasks of their own (else see reopen.cpp)
    _outcome.before_limit = pack(state);
    if (_store != nullptr) _store->keep(_outcome.before_limit);
  }
  _outcome.limited_by |= limits;
}

/// What only the family's end shows, from the stored orbits alone, whatever was probed before.
void BranchTask::finish() {
  if (_curve.known().size() < orbits_from_birth) look_before_first();
  look_behind_last();
  _curve.forget_found();
  const auto probing = [this](double position) { return probe(position); };
  for (const bifurcation::Bracket& b : _detector.finish(probing))
    add_event({bifurcation::Event::Kind::test_function, _functions[b.function], b.tangency, b.passed}, b.from, b.to,
              _curve.known());
  for (const bifurcation::MissedZeros& missed : _detector.missed()) add_missed(missed);
}

/// Positions as they are: which arclength they have is known of the last few orbits only.
void BranchTask::add_missed(const bifurcation::MissedZeros& missed) {
  const bifurcation::Sector& sector = _functions[missed.function].sector;
  _outcome.unlocated.push_back(fmt::format(
      "a multiplier passes exp(2 pi i {}/{}), or its inverse, {} times more than was found, {} to {} of the "
      "survey's lengths along the family",
      sector.j, sector.q, missed.count, missed.from, missed.to));
}

/// False where the branch has arrived at another family.
bool BranchTask::take(const continuation::Orbit& orbit) {
  if (!_last)
    _before_first =
        _work.lineage.crossing.empty() ? 0.0 : continuation::arclength_in_units(*_system, _start.base, orbit.loop);
  _curve.add(orbit.arclength, orbit.loop, kept_orbits);
  if (_outcome.orbits > 0 && _curve.known().size() == orbits_from_birth) look_before_first();
  if (arrive(orbit)) return false;
  // A fold may lie between this orbit and the next.
  if (!_last && _options.too_far && !(_work.amplitude > 0.0) && !_work.base_is_orbit)
    (void)_folds.advance(orbit.arclength - continuation::arclength_between(_start.base, orbit.loop), _start.base.period,
                         continuation::energy_of(*_system, _start.base));
  const std::optional<spectrum::Stability>& stability = stability_at(orbit);
  detect(orbit, stability);
  if (_last) {
    solve_requested(orbit);
    _given.watch(_work.lineage, _start.isotropy, *_last, orbit, _outcome.passed);
  }
  const bool is_other_sides = _work.base_is_orbit && _work.lineage.side < 0 && !_last;
  if (!is_other_sides) store(orbit, stability);
  _last = orbit;
  _last_stability = stability;
  return !(stability && is_nearly_two(*stability) && arrives_ahead());
}

/// Whether an index is so near to 2 that the orbit hardly has a place of its own.
bool BranchTask::is_nearly_two(const spectrum::Stability& stability) {
  return std::any_of(stability.full.begin(), stability.full.end(),
                     [](const std::complex<double>& k) { return std::abs(k - 2.0) < nearly_two; });
}

bool BranchTask::arrives_ahead() {
  if (!_may_arrive_ahead || _curve.known().size() < 2) return false;
  const auto ahead = arrival_ahead(_system, _curve, _symmetry);
  if (ahead) _outcome.arrival.push_back(*ahead);
  return ahead.has_value();
}

std::optional<spectrum::Stability> BranchTask::asked_stability(const loop::Loop& loop) const {
  if (!_scene.compute.stability) return std::nullopt;
  return stability_of(*_system, loop, _start.isotropy, _team);
}

/// Not computed again for the orbit that was asked for last.
const std::optional<spectrum::Stability>& BranchTask::stability_at(const continuation::Orbit& orbit) {
  // Where all but the phase of a drive rests only the parameter tells orbits apart.
  const bool is_asked = _asked && _asked->modes == orbit.loop.modes && _asked->period == orbit.loop.period &&
                        _asked->parameters == orbit.loop.parameters;
  if (!is_asked) {
    _stability = asked_stability(orbit.loop);
    _asked = orbit.loop;
  }
  return _stability;
}

bool BranchTask::jumped(const continuation::Orbit& from, const continuation::Orbit& to) {
  if (!_last_stability) _last_stability = stability_of(*_system, _last->loop, _start.isotropy, _team);
  const std::optional<spectrum::Stability>& after = stability_at(to);
  return _last_stability && after && bifurcation::are_decided(*_last_stability) && bifurcation::are_decided(*after) &&
         bifurcation::has_jumped(_system, _start.isotropy, branch_options(_scene, _team), {from, *_last_stability},
                                 {to, *after});
}

/// Whether, between the equilibrium and the first orbit, lies what the survey looks for.
bool BranchTask::is_too_far(const continuation::Orbit& first) {
  const loop::Loop small = loop::moved(_start.base, _start.direction, nearly_at_rest / _start.direction.norm());
  if (passes_index(small, first)) return true;
  return !(_work.amplitude > 0.0) && (has_requested(first) || has_turned(small, first));
}

bool BranchTask::has_requested(const continuation::Orbit& first) const {
  const auto passes = [](double rest, double there) {
    return [rest, there](double wanted) {
      return (wanted - rest) * (wanted - there) < 0.0 && std::abs(wanted - rest) > at_equilibrium * std::abs(rest);
    };
  };
  const std::vector<double>& periods = _scene.events.periods;
  const std::vector<double>& energies = _scene.events.energies;
  return std::any_of(periods.begin(), periods.end(), passes(_start.base.period, first.loop.period)) ||
         std::any_of(energies.begin(), energies.end(),
                     passes(continuation::energy_of(*_system, _start.base), first.energy));
}

/// Whether T or E turns: both change with the square of the amplitude and with its fourth power, which the orbit of
/// half the amplitude tells.
bool BranchTask::has_turned(const loop::Loop& small, const continuation::Orbit& first) const {
  continuation::FamilyCurve curve(_system, _start.isotropy, branch_options(_scene, _team));
  const double length = continuation::arclength_between(small, first.loop);
  if (length < nearly_at_rest) return false;  // it has the linear motion's period and energy, and half of it is none
  curve.add(0.0, small);
  curve.add(length, first.loop);
  const std::optional<continuation::CurvePoint> half = curve.at(0.5 * length);
  if (!half) return false;
  const auto turns = [&](bifurcation::Fold::Quantity quantity) {
    const double rest = value_of(*_system, quantity, _start.base);
    const double there = value_of(*_system, quantity, first.loop);
    const double change = there - rest;
    const double by_square = (16.0 * (value_of(*_system, quantity, half->loop) - rest) - change) / 3.0;
    const double at_first = 2.0 * change - by_square;  // half the amplitude times the slope there
    const double larger = std::max(std::abs(rest), std::abs(there));
    const auto are_seen = [&](double least) { return std::abs(by_square) > least && std::abs(at_first) > least; };
    return by_square * at_first < 0.0 && are_seen(visible_change(quantity, larger)) &&
           are_seen(16.0 / 3.0 * moved_by_rounding(*_system, _start.isotropy, quantity, half->loop));
  };
  return turns(bifurcation::Fold::Quantity::period) || turns(bifurcation::Fold::Quantity::energy);
}

/// Whether indices pass what the survey looks for, or may do so. Families of one resonance start at one amplitude, and
/// what they pass among each other nearer is known.
bool BranchTask::passes_index(const loop::Loop& small, const continuation::Orbit& first) {
  if (!_at_rest) _at_rest = test_point(0.0, stability_of(*_system, small, _start.isotropy, _team));
  const bool is_resonant = _work.amplitude > 0.0;
  const bifurcation::TestPoint there = test_point(0.0, stability_at(first));
  if (!is_resonant && std::abs(there.turns - _at_rest->turns) > most_turned) return true;
  for (std::size_t f = 0; f < _functions.size(); ++f) {
    const bifurcation::Reading& from = _at_rest->readings[f];
    const bifurcation::Reading& to = there.readings[f];
    if (from.sign() == 0 || to.sign() == 0 || (is_resonant && std::abs(from.value) < largest_change)) continue;
    const double larger = std::max({std::abs(from.value), std::abs(to.value), largest_change});
    if (from.sign() == to.sign() && std::abs(to.value - from.value) <= largest_change * larger) continue;
    if (is_resonant)
      _outcome.remarks.push_back(
          fmt::format("an index changes from {:.3g} at the equilibrium to {:.3g} at the first orbit: nothing was "
                      "looked for between",
                      from.value, to.value));
    return !is_resonant;
  }
  return false;
}

bool BranchTask::arrive(const continuation::Orbit& orbit) {
  bifurcation::SymmetryWatch::SampledOrbit sampled = bifurcation::SymmetryWatch::sampled(orbit.loop);
  if (_last) {
    if (auto arrival = arrival_between(*_system, _curve, _symmetry, *_last, *_sampled, orbit, sampled)) {
      // The met family looks only for crossings of the orders that the scene asks for.
      if (arrival->record.multiplicity > _scene.survey.subharmonics)
        (void)(locate_beneath(_system, _curve.options(), arrival->near, arrival->record) ||
               locate_beneath(_system, _curve.options(), _last->loop, arrival->record));
      _outcome.arrival.push_back(arrival->record);
      _arrival = std::move(*arrival);
    }
  }
  _sampled = std::move(sampled);
  return !_outcome.arrival.empty();
}

bifurcation::TestPoint BranchTask::test_point(double position,
                                              const std::optional<spectrum::Stability>& stability) const {
  bifurcation::TestPoint out{position, {}};
  const bool decided = stability && bifurcation::are_decided(*stability);
  for (const bifurcation::TestFunction& function : _functions) {
    out.readings.push_back(decided ? bifurcation::evaluate(function, _system->structure(), *stability)
                                   : bifurcation::Reading{archive::not_computed, archive::not_computed});
    out.passed.push_back(decided ? bifurcation::zeros_passed(function, *stability) : archive::not_computed);
  }
  if (decided && bifurcation::is_elliptic(*stability)) out.turns = stability->turns;
  return out;
}

std::optional<bifurcation::TestPoint> BranchTask::probe(double position) {
  if (position < _curve.known().front().position) return std::nullopt;  // so far back no orbits are kept
  const std::optional<continuation::CurvePoint> point = _curve.at(position);
  if (!point) return std::nullopt;
  return test_point(position, stability_of(*_system, point->loop, _start.isotropy, _team));
}

void BranchTask::detect_zeros(const bifurcation::TestPoint& point) {
  const auto probing = [this](double position) { return probe(position); };
  for (const bifurcation::Bracket& b : _detector.advance(point, probing))
    add_event({bifurcation::Event::Kind::test_function, _functions[b.function], b.tangency, b.passed}, b.from, b.to,
              _curve.known());
}

void BranchTask::detect(const continuation::Orbit& orbit, const std::optional<spectrum::Stability>& stability) {
  detect_zeros(test_point(orbit.arclength, stability));
  // Where a parameter moves only it folds; T and the energy have extrema that say nothing.
  const bool moves = !orbit.loop.parameters.empty();
  const auto watched = [&](bifurcation::Fold::Quantity quantity, const bifurcation::FoldWatch::Turn& turn) {
    return is_rounding(*_system, _start.isotropy, quantity, turn, orbit.loop, _curve.known())
               ? archive::not_computed
               : value_of(*_system, quantity, orbit.loop);
  };
  using Quantity = bifurcation::Fold::Quantity;
  add_folds(moves ? _folds.advance(orbit.arclength, archive::not_computed, archive::not_computed,
                                   watched(Quantity::parameter, _folds.parameter))
                  : _folds.advance(orbit.arclength, watched(Quantity::period, _folds.period),
                                   watched(Quantity::energy, _folds.energy)),
            _curve.known());
  if (const std::size_t known = _curve.known().size(); known > 2) add_paired_folds(known == 3 ? 0 : known - 3);
}

/// `way`: from this known orbit to the next.
void BranchTask::add_paired_folds(std::size_t way) {
  add_folds(paired_folds(_system, _start.isotropy, branch_options(_scene, _team), _curve.known(), way), _curve.known());
}

void BranchTask::add_folds(const std::vector<bifurcation::Fold>& folds,
                           const std::vector<continuation::FamilyCurve::Known>& known) {
  using Kind = bifurcation::Event::Kind;
  using Quantity = bifurcation::Fold::Quantity;
  for (const bifurcation::Fold& fold : folds) {
    const Kind kind = fold.quantity == Quantity::period   ? Kind::fold_period
                      : fold.quantity == Quantity::energy ? Kind::fold_energy
                                                          : Kind::fold_parameter;
    add_event({kind, {}, false}, fold.from, fold.to, known);
  }
}

void BranchTask::look_before_first() {
  detect_from_birth();
  folds_at_start();
}

/// The first orbit may lie so far out that an index has passed the values of other sectors on the way from the crossing
/// where the family is born.
void BranchTask::detect_from_birth() {
  if (_work.lineage.crossing.empty() || _curve.known().empty()) return;
  const continuation::FamilyCurve::Known& first = _curve.known().front();
  std::vector<continuation::FamilyCurve::Known> known{
      {first.position - continuation::arclength_between(_start.base, first.loop), _start.base,
       first.arclength - _before_first}};
  known.insert(known.end(), _curve.known().begin(), _curve.known().end());
  if (_arrival && known.back().position > _last->arclength) known.pop_back();  // it lies beyond the meeting
  if (!_functions.empty()) indices_from_birth(known);
  folds_from_birth(known);
}

void BranchTask::indices_from_birth(const std::vector<continuation::FamilyCurve::Known>& known) {
  std::optional<spectrum::Stability> birth = stability_of(*_system, _start.base, _start.isotropy, _team);
  // Its value tells: its error bound is that of a place where orbits are not isolated.
  if (birth) std::fill(birth->fundamental_error.begin(), birth->fundamental_error.end(), 0.0);
  const auto at_birth = test_point(0.0, birth);
  const auto at_first = test_point(0.0, stability_of(*_system, known[1].loop, _start.isotropy, _team));
  for (std::size_t f = 0; f < _functions.size(); ++f) {
    const double before = at_birth.readings[f].value;
    const int after = at_first.readings[f].sign();
    const bool is_shown = std::abs(before) > zero_at_birth && before * after < 0.0;
    if (is_shown)
      add_event({bifurcation::Event::Kind::test_function, _functions[f], false}, known[0].position, known[1].position,
                known);
    // Of two places of one function signs show none. The one where a family is born is none.
    const double passed = std::abs(at_first.passed[f] - at_birth.passed[f]);
    if (_functions[f].sector.q > 2 && passed > 1.0)
      add_missed({f, known[0].position, known[1].position, static_cast<int>(passed) - (is_shown ? 1 : 0)});
  }
}

/// Folds that the orbits from the first one on do not show: on the way from the birth to it, and on that to the second.
void BranchTask::folds_from_birth(const std::vector<continuation::FamilyCurve::Known>& known) {
  continuation::FamilyCurve curve(_system, _start.isotropy, branch_options(_scene, _team));
  for (const continuation::FamilyCurve::Known& one : known) curve.add(one);
  const double birth = known[0].position;
  WayToEnd way;
  way.crossing = _start.base;
  if (known.size() > 2) way.inner = known[2];
  double place = known[1].position;
  for (std::size_t n = 0; n < places_from_birth; ++n, place = birth + nearer_to_birth * (place - birth)) {
    auto point = curve.at(place, true);
    if (!point || point->tangent.empty()) break;
    way.points.push_back(std::move(*point));
  }
  add_folds(folds_on(*_system, _start.isotropy, way), known);
}

/// Of a family that goes on behind its first orbit, to the other side: a fold beside it shows on one of the two only.
void BranchTask::folds_at_start() {
  const std::vector<continuation::FamilyCurve::Known>& known = _curve.known();
  if (!_work.base_is_orbit || known.size() < 2) return;
  const auto first = _curve.at(known[0].position, true);
  if (!first || first->tangent.empty()) return;
  add_folds(folds_on(*_system, _start.isotropy, {known[1], {*first}, std::nullopt}), known);
}

/// Folds that no orbit behind the last one shows; on the way from there to a meeting zeros of test functions too.
void BranchTask::look_behind_last() {
  if (!_last || _curve.known().size() < 2) return;
  const auto last = _curve.at(_last->arclength, true);
  if (!last || last->tangent.empty()) return;
  const std::vector<bifurcation::Fold> before_last = _folds.finish(last->position, slopes_at(*_system, *last));
  WayToEnd way;
  way.points = {*last};
  if (_arrival) {
    way.points = places_before(*_arrival, _curve, _symmetry, *last);
    if (way.points.size() > 1) way.crossing = way.points.back().loop;
  }
  add_folds(borne_out(*_system, _start.isotropy, before_last, way), _curve.known());
  if (!_arrival) {
    if (_curve.known().size() > 2) add_paired_folds(_curve.known().size() - 2);
    return;
  }
  add_behind(way.points);
  std::vector<continuation::Orbit> behind = orbits_to_zeros(way.points);
  add_folds(folds_on(*_system, _start.isotropy, way), _curve.known());
  if (way.points.size() > 1) {
    const continuation::Orbit near = orbit_of(*_system, way.points.back().loop, way.points.back().position);
    for (continuation::Orbit& wanted : requested_orbits(_scene, *_system, _curve, *_last, near, _outcome.remarks))
      behind.push_back(std::move(wanted));
  }
  std::sort(behind.begin(), behind.end(), [](const auto& x, const auto& y) { return x.arclength < y.arclength; });
  for (const continuation::Orbit& orbit : behind) store(orbit, asked_stability(orbit.loop));
}

/// The places behind the last orbit become known orbits, as if the branch had stepped to them.
void BranchTask::add_behind(std::vector<continuation::CurvePoint>& places) {
  _curve.drop_behind(_last->arclength);
  for (std::size_t n = 1; n < places.size(); ++n) {
    places[n].position = places[n - 1].position + continuation::arclength_between(places[n - 1].loop, places[n].loop);
    _curve.add(places[n].position, places[n].loop, kept_orbits + n);
  }
}

/// Of the places behind the last orbit those up to the last zero of a test function: crossings lie within families.
std::vector<continuation::Orbit> BranchTask::orbits_to_zeros(const std::vector<continuation::CurvePoint>& places) {
  std::vector<continuation::Orbit> orbits;
  for (std::size_t n = 1; n < places.size(); ++n) {
    const int known = _events;
    detect_zeros(test_point(places[n].position, asked_stability(places[n].loop)));
    while (_events > known && orbits.size() < n) {
      const continuation::CurvePoint& place = places[orbits.size() + 1];
      orbits.push_back(orbit_of(*_system, place.loop, place.position));
    }
  }
  return orbits;
}

void BranchTask::add_event(const bifurcation::Event& event, double from, double to,
                           std::vector<continuation::FamilyCurve::Known> known) {
  // A family's own birth is no event: its index leaves 2 there like a power of the distance, first within its error.
  const bool at_birth = _work.lineage.depth > 0 && from <= 0.0;
  const bool is_fold = event.kind != bifurcation::Event::Kind::test_function;
  const bool is_in_sector = !is_fold && bifurcation::has_sector(event.function.kind);
  if (at_birth && is_in_sector && event.function.sector.q == 1) return;
  LocateWork work;
  work.event = event;
  const std::string what = is_fold        ? "fold"
                           : is_in_sector ? fmt::format("q{}.j{}", event.function.sector.q, event.function.sector.j)
                                          : std::string(bifurcation::name_of(event.function.kind));
  work.key = event_key(_work.key, _events++, what);
  work.name = _work.name;
  work.lineage = _work.lineage;
  work.isotropy = _work.isotropy;
  work.before_first = _before_first;
  work.from = std::max(from, known.front().position);  // a long way without a sign may begin before
  work.known = std::move(known);
  work.to = to;
  queue::Task& task = _children.emplace_back(task_of(work));
  if (_store != nullptr) _store->keep(task);
}

void BranchTask::solve_requested(const continuation::Orbit& orbit) {
  for (continuation::Orbit& wanted : requested_orbits(_scene, *_system, _curve, *_last, orbit, _outcome.remarks))
    store(wanted, asked_stability(wanted.loop));
}

void BranchTask::store(continuation::Orbit orbit, const std::optional<spectrum::Stability>& stability) {
  const bool first = _outcome.orbits == 0;
  const double period = orbit.loop.period * units().time;
  const double level = continuation::level_of(*_system, orbit.loop) * units().level();
  _outcome.period_from = first ? period : std::min(_outcome.period_from, period);
  _outcome.period_to = first ? period : std::max(_outcome.period_to, period);
  _outcome.level_from = first ? level : std::min(_outcome.level_from, level);
  _outcome.level_to = first ? level : std::max(_outcome.level_to, level);
  _outcome.last_period = period;
  _outcome.last_level = level;
  _outcome.last_cutoff = orbit.loop.cutoff;
  _outcome.tolerance_met = std::max(_outcome.tolerance_met, orbit.tolerance_met);
  _outcome.moved_out = std::max(_outcome.moved_out, orbit.moved_out);
  // The other side of a crossing: counted backwards from it.
  orbit.step = _work.lineage.side > 0 ? _outcome.orbits : -1 - _outcome.orbits;
  orbit.arclength = signed_arclength(_work.lineage, _before_first, _curve.arclength_at(orbit.arclength));
  const loop::Loop stored = loop::in_standard_phase(_system->structure(), orbit.loop, _start.isotropy);
  _rows.orbits.push_back(
      orbit_row(*_system, _work.lineage.family, orbit, stored, stability, _certifier ? &*_certifier : nullptr));
  for (archive::SectionRecord& row : section_rows(_scene.section, *_system, stored, _work.lineage.family, orbit.step))
    _rows.sections.push_back(std::move(row));
  ++_outcome.orbits;
}

}  // namespace orbweaver::survey
