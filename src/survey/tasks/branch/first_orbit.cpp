#include "first_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/branch/foldable.hpp"
#include "tasks/orbit_row.hpp"

namespace orbweaver::survey {

namespace {

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

}  // namespace

bool FirstOrbit::is_too_far(const continuation::Orbit& first) {
  const loop::Loop small =
      loop::moved(_followed.start.base, _followed.start.direction, nearly_at_rest / _followed.start.direction.norm());
  if (passes_index(small, first)) return true;
  return !(_followed.work.amplitude > 0.0) && (has_requested(first) || has_turned(small, first));
}

bool FirstOrbit::has_requested(const continuation::Orbit& first) const {
  const auto passes = [](double rest, double there) {
    return [rest, there](double wanted) {
      return (wanted - rest) * (wanted - there) < 0.0 && std::abs(wanted - rest) > at_equilibrium * std::abs(rest);
    };
  };
  const std::vector<double>& periods = _followed.scene.events.periods;
  const std::vector<double>& energies = _followed.scene.events.energies;
  return std::any_of(periods.begin(), periods.end(), passes(_followed.start.base.period, first.loop.period)) ||
         std::any_of(energies.begin(), energies.end(),
                     passes(continuation::energy_of(*_followed.system, _followed.start.base), first.energy));
}

/// Whether T or E turns: both change with the square of the amplitude and with its fourth power, which the orbit of
/// half the amplitude tells.
bool FirstOrbit::has_turned(const loop::Loop& small, const continuation::Orbit& first) const {
  continuation::FamilyCurve curve(_followed.system, _followed.start.isotropy,
                                  branch_options(_followed.scene, _followed.team));
  const double length = continuation::arclength_between(small, first.loop);
  if (length < nearly_at_rest) return false;  // it has the linear motion's period and energy, and half of it is none
  curve.add(0.0, small);
  curve.add(length, first.loop);
  const std::optional<continuation::CurvePoint> half = curve.at(0.5 * length);
  if (!half) return false;
  const auto turns = [&](bifurcation::Fold::Quantity quantity) {
    const double rest = value_of(*_followed.system, quantity, _followed.start.base);
    const double there = value_of(*_followed.system, quantity, first.loop);
    const double change = there - rest;
    const double by_square = (16.0 * (value_of(*_followed.system, quantity, half->loop) - rest) - change) / 3.0;
    const double at_first = 2.0 * change - by_square;  // half the amplitude times the slope there
    const double larger = std::max(std::abs(rest), std::abs(there));
    const auto are_seen = [&](double least) { return std::abs(by_square) > least && std::abs(at_first) > least; };
    return by_square * at_first < 0.0 && are_seen(visible_change(quantity, larger)) &&
           are_seen(16.0 / 3.0 * moved_by_rounding(*_followed.system, _followed.start.isotropy, quantity, half->loop));
  };
  return turns(bifurcation::Fold::Quantity::period) || turns(bifurcation::Fold::Quantity::energy);
}

/// Whether indices pass what the survey looks for, or may do so. Families of one resonance start at one amplitude, and
/// what they pass among each other nearer is known.
bool FirstOrbit::passes_index(const loop::Loop& small, const continuation::Orbit& first) {
  if (!_at_rest)
    _at_rest =
        _followed.test_point(0.0, stability_of(*_followed.system, small, _followed.start.isotropy, _followed.team));
  const bool is_resonant = _followed.work.amplitude > 0.0;
  const bifurcation::TestPoint there = _followed.test_point(0.0, _followed.stability_at(first));
  if (!is_resonant && std::abs(there.turns - _at_rest->turns) > most_turned) return true;
  for (std::size_t f = 0; f < _followed.functions.size(); ++f) {
    const bifurcation::Reading& from = _at_rest->readings[f];
    const bifurcation::Reading& to = there.readings[f];
    if (from.sign() == 0 || to.sign() == 0 || (is_resonant && std::abs(from.value) < largest_change)) continue;
    const double larger = std::max({std::abs(from.value), std::abs(to.value), largest_change});
    if (from.sign() == to.sign() && std::abs(to.value - from.value) <= largest_change * larger) continue;
    if (is_resonant)
      _followed.outcome.remarks.push_back(
          fmt::format("an index changes from {:.3g} at the equilibrium to {:.3g} at the first orbit: nothing was "
                      "looked for between",
                      from.value, to.value));
    return !is_resonant;
  }
  return false;
}

}  // namespace orbweaver::survey
