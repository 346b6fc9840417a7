#include "branch_events.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/continuation/left_open.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/branch/fold_pairs.hpp"
#include "tasks/branch/foldable.hpp"
#include "tasks/orbit_row.hpp"
#include "tasks/payload/keys.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

namespace {

/// Of the way from a birth or to a meeting: an orbit that rounding leaves open by more across its family tells no index
/// of 2 there. Not measured.
constexpr double open_at_end = 0.1;
/// Of the function of the multiplier 1, which is zero at a meeting: at the nearest orbit before it that is found. Not
/// measured.
constexpr double short_of_meeting = 0.5;

bool is_of_one(const bifurcation::TestFunction& function) {
  return bifurcation::has_sector(function.kind) && function.sector.q == 1;
}

}  // namespace

void BranchEvents::go_on(bifurcation::DetectorState detector, const bifurcation::FoldWatch& folds, int count,
                         double passed_one, std::vector<queue::Task> tasks) {
  _detector = bifurcation::Detector(std::move(detector), {});
  _folds = folds;
  _count = count;
  _passed_one = passed_one;
  _tasks = std::move(tasks);
}

void BranchEvents::watch_from_rest(const continuation::Orbit& first) {
  (void)_folds.advance(first.arclength - continuation::arclength_between(_followed.start.base, first.loop),
                       _followed.start.base.period, continuation::energy_of(*_followed.system, _followed.start.base));
}

std::optional<spectrum::Stability> BranchEvents::stability_between(double position) {
  const std::optional<continuation::CurvePoint> point = _followed.curve.at(position);
  if (!point) return std::nullopt;
  return stability_of(*_followed.system, point->loop, _followed.start.isotropy, _followed.team);
}

std::optional<bifurcation::TestPoint> BranchEvents::probe(double position) {
  if (position < _followed.curve.known().front().position) return std::nullopt;  // so far back no orbits are kept
  const std::optional<continuation::CurvePoint> point = _followed.curve.at(position);
  if (!point) return std::nullopt;
  return test_point(position, point->loop,
                    stability_of(*_followed.system, point->loop, _followed.start.isotropy, _followed.team));
}

/// An index leaves 2 there like a power of the way, within what rounding makes of it first: its bound does not tell.
bool BranchEvents::is_hidden_beside_end(double way, const loop::Loop& loop) const {
  if (way <= _hidden_to) return true;
  if (way >= _told_from) return false;
  const double across = continuation::left_open_by_rounding(*_followed.system, loop, _followed.start.isotropy).across;
  const bool is_told = across > 0.0 && across < open_at_end * way;
  (is_told ? _told_from : _hidden_to) = way;
  return !is_told;
}

void BranchEvents::forget_hidden() {
  _hidden_to = 0.0;
  _told_from = std::numeric_limits<double>::infinity();
}

void BranchEvents::go_to_meeting(double last, double meeting) {
  forget_hidden();
  _last = last;
  _meeting = meeting;
}

bifurcation::TestPoint BranchEvents::test_point(double position, const loop::Loop& loop,
                                                const std::optional<spectrum::Stability>& stability) const {
  bifurcation::TestPoint point = _followed.test_point(position, stability);
  const bool is_behind = position > _last;
  const bool is_beside_end = is_behind || (_followed.work.lineage.depth > 0 && position <= 0.0);
  for (std::size_t f = 0; f < point.readings.size(); ++f) {
    if (!is_beside_end || !is_of_one(_followed.functions[f])) continue;
    double& error = point.readings[f].error;
    error *= bifurcation::error_margin;
    const double size = std::abs(point.readings[f].value);
    if (!(size > error) || size > bifurcation::zero_at_birth) continue;
    const double way = is_behind ? _meeting - position : continuation::arclength_between(_followed.start.base, loop);
    if (is_hidden_beside_end(way, loop)) error = bifurcation::zero_at_birth;
  }
  return point;
}

void BranchEvents::detect_zeros(const bifurcation::TestPoint& point) {
  const auto probing = [this](double position) { return probe(position); };
  add_zeros(_detector.advance(point, probing));
}

void BranchEvents::add_zeros(const std::vector<bifurcation::Bracket>& brackets) {
  for (const bifurcation::Bracket& b : brackets) {
    const bifurcation::TestFunction& function = _followed.functions[b.function];
    if (is_of_one(function)) {
      if (b.tangency && b.to > _last) continue;  // it goes to zero there at the meeting
      if (!b.tangency) _passed_one = b.to;
    }
    add_event({.function = function, .tangency = b.tangency, .passed = b.passed, .is_double = b.is_double}, b.from,
              b.to, _followed.curve.known());
  }
}

void BranchEvents::add_zeros_from_birth(const std::vector<bifurcation::Bracket>& brackets,
                                        const std::vector<continuation::FamilyCurve::Known>& known) {
  for (const bifurcation::Bracket& b : brackets) {
    const bifurcation::TestFunction& function = _followed.functions[b.function];
    if (is_of_one(function) && b.tangency) continue;
    add_event({.function = function,
               .tangency = b.tangency,
               .passed = b.passed,
               .from_birth = b.from == known.front().position,
               .is_double = b.is_double},
              b.from, b.to, known);
  }
}

void BranchEvents::add_zeros_at_start(const std::vector<bifurcation::Bracket>& brackets,
                                      const std::vector<continuation::FamilyCurve::Known>& known) {
  for (const bifurcation::Bracket& b : brackets)
    add_event({.function = _followed.functions[b.function],
               .tangency = b.tangency,
               .passed = b.passed,
               .is_double = b.is_double},
              b.from, b.to, known);
}

void BranchEvents::add_untold_start() {
  _followed.outcome.unlocated.emplace_back(
      "at its first orbit a multiplier passes a root of unity, or comes to it, and no orbit converges on the other "
      "side");
}

void BranchEvents::detect_meetings(const bifurcation::StabilityAt& from, const bifurcation::StabilityAt& to) {
  const auto between = [this](double position) { return stability_between(position); };
  for (const bifurcation::StabilityAt& met : bifurcation::meetings_between(from, to, between))
    detect_zeros(_followed.test_point(met.position, met.stability));
}

void BranchEvents::detect(const continuation::Orbit& orbit, const std::optional<spectrum::Stability>& stability) {
  bifurcation::TestPoint point = test_point(orbit.arclength, orbit.loop, stability);
  point.halvings = (orbit.halvings + 1) / 2;  // what these show asks for more
  detect_zeros(point);
  const std::vector<continuation::FamilyCurve::Known>& known = _followed.curve.known();
  for (int n = 1, pieces = 1 << orbit.halvings; n < pieces && known.size() > 1; ++n) {
    const double from = known[known.size() - 2].position;
    const double position = from + n * (orbit.arclength - from) / pieces;
    if (const auto between = _followed.curve.at(position)) watch_folds(position, between->loop);
  }
  watch_folds(orbit.arclength, orbit.loop);
  if (known.size() > 2) add_paired_folds(known.size() == 3 ? 0 : known.size() - 3);
}

void BranchEvents::watch_folds(double position, const loop::Loop& loop) {
  // Where a parameter moves only it folds; T and the energy have extrema that say nothing.
  const bool moves = !loop.parameters.empty();
  const auto watched = [&](bifurcation::Fold::Quantity quantity, const bifurcation::FoldWatch::Turn& turn) {
    return is_rounding(*_followed.system, _followed.start.isotropy, quantity, turn, loop, _followed.curve.known())
               ? archive::not_computed
               : value_of(*_followed.system, quantity, loop);
  };
  using Quantity = bifurcation::Fold::Quantity;
  for (const bifurcation::Fold& fold : moves ? _folds.advance(position, archive::not_computed, archive::not_computed,
                                                              watched(Quantity::parameter, _folds.parameter))
                                             : _folds.advance(position, watched(Quantity::period, _folds.period),
                                                              watched(Quantity::energy, _folds.energy)))
    add_watched(fold);
}

void BranchEvents::add_watched(const bifurcation::Fold& fold) {
  const std::vector<continuation::FamilyCurve::Known>& known = _followed.curve.known();
  const bool is_kept = known.size() < kept_orbits || fold.from >= known.front().position;
  if (is_kept || is_in_known(fold)) return add_folds({fold}, known);
  const bool is_period = fold.quantity == bifurcation::Fold::Quantity::period;
  if (!is_period && _passed_one > fold.from) return;
  const Units units(*_followed.system);
  const double value = value_of(*_followed.system, fold.quantity, known.front().loop);
  _followed.outcome.unlocated.push_back(fmt::format(
      "{0} turns near {1:.12g} between {2:.6g} and {3:.6g} of the survey's lengths along the family, where it changes "
      "by less than {4:.0e} of its size: where is hidden by rounding",
      is_period ? "T" : units.level_name(), value * (is_period ? units.time : units.level()), fold.from,
      known.front().position, bifurcation::FoldWatch::visible_change));
}

/// Whether the known orbits show the turn of a fold that the watch has found from before them: one between two others
/// is beyond both, by more than rounding moves it.
bool BranchEvents::is_in_known(const bifurcation::Fold& fold) const {
  const std::vector<continuation::FamilyCurve::Known>& known = _followed.curve.known();
  const auto value = [&](const loop::Loop& loop) { return value_of(*_followed.system, fold.quantity, loop); };
  const double first = value(known.front().loop);
  const double direction = value(known.back().loop) > first ? 1.0 : -1.0;
  return std::any_of(known.begin() + 1, known.end() - 1, [&](const continuation::FamilyCurve::Known& one) {
    const double beyond = direction * (first - value(one.loop));
    return beyond > 0.0 &&
           beyond > moved_by_rounding(*_followed.system, _followed.start.isotropy, fold.quantity, one.loop);
  });
}

void BranchEvents::add_paired_folds(std::size_t way) {
  add_folds(paired_folds(_followed.system, _followed.start.isotropy, branch_options(_followed.scene, _followed.team),
                         _followed.curve.known(), way),
            _followed.curve.known());
}

void BranchEvents::add_folds(const std::vector<bifurcation::Fold>& folds,
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

void BranchEvents::add_event(const bifurcation::Event& event, double from, double to,
                             std::vector<continuation::FamilyCurve::Known> known) {
  const bool is_fold = event.kind != bifurcation::Event::Kind::test_function;
  const bool is_in_sector = !is_fold && bifurcation::has_sector(event.function.kind);
  LocateWork work;
  work.event = event;
  const std::string what = is_fold        ? "fold"
                           : is_in_sector ? fmt::format("q{}.j{}", event.function.sector.q, event.function.sector.j)
                                          : std::string(bifurcation::name_of(event.function.kind));
  work.key = event_key(_followed.work.key, _count++, what);
  work.name = _followed.work.name;
  work.lineage = _followed.work.lineage;
  work.isotropy = _followed.work.isotropy;
  work.before_first = _followed.outcome.before_first;
  work.from = std::max(from, known.front().position);  // a long way without a sign may begin before
  work.known = std::move(known);
  work.to = to;
  queue::Task& task = _tasks.emplace_back(task_of(work));
  if (_store != nullptr) _store->keep(task);
}

/// Positions as they are: which arclength they have is known of the last few orbits only.
void BranchEvents::add_missed(const bifurcation::MissedZeros& missed) {
  const bifurcation::TestFunction& function = _followed.functions[missed.function];
  const std::string what =
      bifurcation::has_sector(function.kind)
          ? fmt::format("a multiplier passes exp(2 pi i {}/{}), or its inverse,", function.sector.j, function.sector.q)
          : "a complex pair of multipliers passes the unit circle";
  _followed.outcome.unlocated.push_back(
      fmt::format("{} {} times more than was found, {} to {} of the survey's lengths along the family", what,
                  missed.count, missed.from, missed.to));
}

bool BranchEvents::add_short_of_meeting(const bifurcation::TestPoint& nearest) {
  for (std::size_t f = 0; f < nearest.readings.size(); ++f) {
    if (!is_of_one(_followed.functions[f]) || !(std::abs(nearest.readings[f].value) > short_of_meeting)) continue;
    _followed.outcome.unlocated.push_back(fmt::format(
        "of the way from its last orbit to where it meets another family orbits are found up to {:.6g} of the survey's "
        "lengths along the family only, where no multiplier is near 1: crossings beyond are not seen",
        _followed.curve.arclength_at(nearest.position)));
    return true;
  }
  return false;
}

void BranchEvents::finish_zeros() {
  const auto probing = [this](double position) { return probe(position); };
  add_zeros(_detector.finish(probing));
  for (const bifurcation::MissedZeros& missed : _detector.missed()) add_missed(missed);
}

}  // namespace orbweaver::survey
