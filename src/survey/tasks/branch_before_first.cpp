// What a branch asks of the way between its birth and its first orbit.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "branch_task.hpp"
#include "end_folds.hpp"
#include "executor.hpp"
#include "orbit_row.hpp"

namespace orbweaver::survey {

namespace {

/// Places from a family's second orbit to its birth at which slopes tell folds, from the first orbit on each so much
/// nearer to the birth than the one before: the last is a thousandth of the first orbit's way from it.
constexpr std::size_t places_from_birth = 7;
constexpr double nearer_to_birth = 0.25;

/// Test functions of a family's birth that are smaller vanish there, the family's own for one. Their error bounds say
/// nothing: they take a Newton step, and the orbits of two families lie side by side. The crossing is located to 1e-9.
constexpr double zero_at_birth = 1e-6;

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
/// Relative to their size, of changes of T and E: ten times what a fold is seen by (bifurcation/fold_watch), for
/// what differences of them are off.
constexpr double visible_change = 1e-9;

}  // namespace

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
  curve.add(0.0, small);
  curve.add(length, first.loop);
  const std::optional<continuation::CurvePoint> half = curve.at(0.5 * length);
  if (!half) return false;
  const auto turns = [](double rest, double middle, double there) {
    const double change = there - rest;
    const double by_square = (16.0 * (middle - rest) - change) / 3.0;
    const double at_first = 2.0 * change - by_square;  // half the amplitude times the slope there
    const double seen = visible_change * std::max(std::abs(rest), std::abs(there));
    return std::abs(by_square) > seen && std::abs(at_first) > seen && by_square * at_first < 0.0;
  };
  return turns(_start.base.period, half->loop.period, first.loop.period) ||
         turns(continuation::energy_of(*_system, _start.base), continuation::energy_of(*_system, half->loop),
               first.energy);
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

}  // namespace orbweaver::survey
