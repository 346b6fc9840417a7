#include "requested.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::survey {

namespace {

/// Width of the bracket in arclength, relative to 1 + the arclength: rounding of a position.
constexpr double position_width = 1e-14;

/// What is asked for along a family: T or E.
struct Quantity {
  std::function<double(const loop::Loop&)> value;
  std::function<double(const continuation::CurvePoint&)> slope;  ///< where there is a tangent
};

/// Beyond two neighbours that lie on one side of a value the curve goes no further than the slopes beside them lead,
/// which a fold makes smaller: so many times what differences say of them.
constexpr double reach = 2.0;

class Search {
 public:
  Search(const Quantity& quantity, double wanted, continuation::FamilyCurve& family, const continuation::Orbit& from,
         const continuation::Orbit& to)
      : _quantity(quantity),
        _wanted(wanted),
        _family(family),
        _from{from.arclength, off(from.loop)},
        _to{to.arclength, off(to.loop)},
        _width(position_width * (1.0 + to.arclength)) {}

  /// Brackets of the places between the two orbits where the quantity is the wanted one: one, two around a fold, or
  /// none.
  [[nodiscard]] std::vector<std::pair<numerics::Place, numerics::Place>> brackets() const {
    if (_from.value * _to.value < 0.0) return {{_from, _to}};
    if (!(_from.value * _to.value > 0.0) || !may_pass_between()) return {};
    const auto slope = [&](double position) {
      const auto point = _family.at(position, true);
      return point && !point->tangent.empty() ? _quantity.slope(*point) : std::numeric_limits<double>::quiet_NaN();
    };
    const double before = slope(_from.position);
    const double behind = slope(_to.position);
    if (!(before * _from.value < 0.0 && behind * _to.value > 0.0)) return {};
    const auto fold = numerics::locate_root(slope, {_from.position, before}, {_to.position, behind}, _width);
    if (!fold) return {};
    const numerics::Place turn{fold->position, at(fold->position)};
    if (!(turn.value * _from.value < 0.0)) return {};
    return {{_from, turn}, {turn, _to}};
  }

  [[nodiscard]] std::optional<continuation::CurvePoint> orbit_in(const numerics::Place& from,
                                                                 const numerics::Place& to) const {
    const auto located = numerics::locate_root([&](double position) { return at(position); }, from, to, _width);
    return located ? _family.at(located->position) : std::nullopt;
  }

 private:
  [[nodiscard]] double off(const loop::Loop& loop) const { return _quantity.value(loop) - _wanted; }
  [[nodiscard]] double at(double position) const {
    const auto point = _family.at(position);
    return point ? off(point->loop) : std::numeric_limits<double>::quiet_NaN();
  }

  /// False where the value is so far off that the curve does not come to it, at no cost.
  [[nodiscard]] bool may_pass_between() const {
    const continuation::FamilyCurve::Known* before = nullptr;
    for (const continuation::FamilyCurve::Known& known : _family.known())
      if (known.position < _from.position) before = &known;
    if (before == nullptr) return true;
    const double rate = (_from.value - off(before->loop)) / (_from.position - before->position);
    const double furthest = std::abs(rate) * (_to.position - _from.position) + std::abs(_to.value - _from.value);
    return std::min(std::abs(_from.value), std::abs(_to.value)) <= reach * furthest;
  }

  const Quantity& _quantity;
  double _wanted;
  continuation::FamilyCurve& _family;
  numerics::Place _from;
  numerics::Place _to;
  double _width;
};

}  // namespace

continuation::Orbit orbit_of(const systems::System& system, const loop::Loop& loop, double arclength) {
  continuation::Orbit orbit;
  orbit.loop = loop;
  orbit.arclength = arclength;
  orbit.energy = continuation::energy_of(system, loop);
  orbit.action = continuation::action_of(system, loop);
  orbit.loss_rms = std::sqrt(loss::Linearization(system, loop, loss::Linearization::Order::residual).loss());
  orbit.tail = loop::tail(loop);
  return orbit;
}

std::vector<continuation::Orbit> requested_orbits(const scene::Scene& scene, const systems::System& system,
                                                  continuation::FamilyCurve& family, const continuation::Orbit& from,
                                                  const continuation::Orbit& to, std::vector<std::string>& remarks) {
  std::vector<continuation::Orbit> found;
  const systems::Scales& units = system.scales();
  const auto missing = [&](const char* what, double value) {
    remarks.push_back(fmt::format("the orbit of {} {:.12g} between arclength {:.6g} and {:.6g} could not be converged",
                                  what, value, family.arclength_at(from.arclength), family.arclength_at(to.arclength)));
  };
  const Quantity period{[](const loop::Loop& loop) { return loop.period; }, bifurcation::period_slope};
  for (const double wanted : scene.events.periods) {
    const Search search(period, wanted, family, from, to);
    for (const auto& [before, behind] : search.brackets()) {
      const auto near = search.orbit_in(before, behind);
      const auto exact = near ? std::optional(continuation::orbit_at_period(system, near->loop, family.isotropy(),
                                                                            wanted, family.options()))
                              : std::nullopt;
      if (exact && exact->converged())
        found.push_back(orbit_of(system, exact->loop, near->position));
      else
        missing("period", wanted * units.time);
    }
  }
  const Quantity energy{
      [&](const loop::Loop& loop) { return continuation::energy_of(system, loop); },
      [&](const continuation::CurvePoint& point) { return bifurcation::energy_slope(system, point); }};
  for (const double wanted : scene.events.energies) {
    const Search search(energy, wanted, family, from, to);
    for (const auto& [before, behind] : search.brackets()) {
      if (const auto there = search.orbit_in(before, behind))
        found.push_back(orbit_of(system, there->loop, there->position));
      else
        missing("energy", wanted * units.energy());
    }
  }
  std::sort(found.begin(), found.end(),
            [](const continuation::Orbit& a, const continuation::Orbit& b) { return a.arclength < b.arclength; });
  return found;
}

}  // namespace orbweaver::survey
