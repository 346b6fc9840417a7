#include "orbweaver/refine/stored_family.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"

namespace orbweaver::refine {

namespace {

/// Orbits that a polynomial along the family runs through, as the predictor of branches does.
constexpr std::size_t orbits_beside = 6;
/// What a symmetry of the family may be off at a guess between two orbits, in the scales.
constexpr double symmetry_of_a_guess = 1e-2;
constexpr double place_tolerance = 1e-12;  // in arclength

bool is_between(double value, double a, double b) { return (a <= value && value < b) || (b < value && value <= a); }

/// A value as a double that reads as it, since systems are bound with doubles.
double parameter_value(const std::string& name, const std::string& decimal) {
  constexpr int enough = 60;
  const numerics::WorkingDigits working(enough);
  const numerics::Extended meant = numerics::extended_of(decimal);
  const auto value = static_cast<double>(meant);
  if (numerics::extended_of(numerics::shortest_decimal(value)) != meant)
    throw core::InputError(
        fmt::format("expected a value of {} that double precision reads as written, got `{}`; `{}` is the nearest",
                    name, decimal, numerics::shortest_decimal(value)));
  return value;
}

}  // namespace

StoredFamily::StoredFamily(const archive::Archive& atlas, std::size_t family)
    : _atlas(atlas), _system(survey::scaled_system_of(atlas)) {
  _choice = survey::scene_of(atlas).system;
  _plain = scene::bound_system(_choice);
  if (!_choice.moving.free.empty()) _parameter = _choice.moving.free.front();
  const archive::Table& table = atlas.families();
  _name = table.texts("name")[family];
  _isotropy_text = table.texts("isotropy")[family];
  _isotropy = in_standard_phase(_system->structure(), loop::isotropy_of(_system->structure(), _isotropy_text));
  const auto count = static_cast<std::size_t>(table.integers("orbit_count")[family]);
  if (count < 2)
    throw core::InputError(fmt::format("{} cannot be refined: it has {} orbits, and two are needed", _name, count));
  _first_orbit = static_cast<std::size_t>(table.integers("first_orbit")[family]);
  const std::vector<double>& arclengths = atlas.orbits().reals("arclength");
  _arclengths.assign(arclengths.begin() + static_cast<std::ptrdiff_t>(_first_orbit),
                     arclengths.begin() + static_cast<std::ptrdiff_t>(_first_orbit + count));
}

StoredFamily StoredFamily::named(const archive::Archive& atlas, const std::string& name) {
  const std::vector<std::string>& names = atlas.families().texts("name");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw core::InputError(fmt::format("{} has no family `{}`; `{}` lists them", atlas.path().string(), name,
                                       core::command_line({"show", atlas.path().string(), "families"})));
  return {atlas, static_cast<std::size_t>(found - names.begin())};
}

int StoredFamily::step_of(std::size_t orbit) const {
  return static_cast<int>(_atlas.orbits().integers("step")[_first_orbit + orbit]);
}

std::size_t StoredFamily::index_of(int step) const {
  const int first = step_of(0);
  const int last = step_of(_arclengths.size() - 1);
  if (step < first || step > last)
    throw core::InputError(fmt::format("{} has the steps {} to {}, and no step {}", _name, first, last, step));
  return static_cast<std::size_t>(step - first);
}

std::vector<double> StoredFamily::values(HeldValue::Quantity quantity) const {
  using Quantity = HeldValue::Quantity;
  const char* name = quantity == Quantity::period ? "period" : quantity == Quantity::energy ? "energy" : "parameter";
  const std::vector<double>& column = _atlas.orbits().reals(name);
  return {column.begin() + static_cast<std::ptrdiff_t>(_first_orbit),
          column.begin() + static_cast<std::ptrdiff_t>(_first_orbit + _arclengths.size())};
}

std::string StoredFamily::letter_of(HeldValue::Quantity quantity) const {
  if (quantity == HeldValue::Quantity::parameter) return _parameter;
  return quantity == HeldValue::Quantity::period ? "T" : "E";
}

std::shared_ptr<const systems::System> StoredFamily::plain_at(double value) const {
  if (_parameter.empty()) return _plain;
  scene::SystemChoice choice = _choice;
  choice.parameters[_parameter] = value;
  choice.moving = {};
  return scene::bound_system(choice);
}

std::string StoredFamily::stored(HeldValue::Quantity quantity, int step) const {
  return numerics::shortest_decimal(values(quantity)[index_of(step)]);
}

StoredFamily::Neighbours StoredFamily::beside(double arclength) const {
  const auto after = std::lower_bound(_arclengths.begin(), _arclengths.end(), arclength);
  const auto next = static_cast<std::size_t>(after - _arclengths.begin());
  const std::size_t count = std::min(orbits_beside, _arclengths.size());
  const std::size_t half = count / 2;
  const std::size_t first = std::min(next > half ? next - half : 0, _arclengths.size() - count);
  return {first, first + count};
}

StoredFamily::Place StoredFamily::at_step(int step) const {
  const double value = _parameter.empty() ? 0.0 : values(HeldValue::Quantity::parameter)[index_of(step)];
  Place place = placed(_arclengths[index_of(step)], plain_at(value));
  place.first_step = step;
  place.last_step = step;
  return place;
}

StoredFamily::Place StoredFamily::with(const HeldValue& value, std::optional<int> after) const {
  const double wanted = std::strtod(value.decimal.c_str(), nullptr);  // of what no double is: infinity, or 0
  const std::vector<double> known = values(value.quantity);
  std::vector<std::size_t> places;
  for (std::size_t n = after ? index_of(*after) : 0; n < known.size(); ++n) {
    const bool is_last = n + 1 == known.size();
    if (is_last ? known[n] == wanted : is_between(wanted, known[n], known[n + 1])) places.push_back(n);
  }
  if (places.empty()) {
    const auto [least, most] = std::minmax_element(known.begin(), known.end());
    throw core::InputError(fmt::format("{} has no orbit with {} = {}{}: it reaches from {:.6g} to {:.6g}", _name,
                                       letter_of(value.quantity), value.decimal,
                                       after ? fmt::format(" after step {}", *after) : "", *least, *most));
  }
  if (places.size() > 1 && !after) {
    std::vector<int> steps;
    for (const std::size_t n : places) steps.push_back(step_of(n));
    throw core::InputError(fmt::format("{} has {} orbits with {} = {}, after the steps {}: choose one with --after",
                                       _name, places.size(), letter_of(value.quantity), value.decimal,
                                       fmt::join(steps, ", ")));
  }
  const std::size_t n = places.front();
  double arclength = _arclengths[n];
  if (known[n] != wanted) {
    const Neighbours near = beside(0.5 * (_arclengths[n] + _arclengths[n + 1]));
    const std::span<const double> nodes(_arclengths.data() + near.first, near.end - near.first);
    const auto along = [&](double position) {
      const std::vector<double> weights = numerics::lagrange_weights(nodes, position).value;
      double sum = -wanted;
      for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * known[near.first + i];
      return sum;
    };
    const auto located = numerics::locate_root(along, _arclengths[n], _arclengths[n + 1], place_tolerance);
    if (located) arclength = located->position;
  }
  Place place = placed(arclength, plain_at(wanted));
  place.first_step = step_of(n);
  place.last_step = known[n] == wanted ? place.first_step : step_of(n + 1);
  return place;
}

StoredFamily::Named StoredFamily::named_orbit(const std::string& text, std::optional<int> after) const {
  using Quantity = HeldValue::Quantity;
  if (!_parameter.empty()) return of_parameter(text, after);
  const auto named = [this](Place place, const HeldValue& held) {
    return Named{std::move(place), held, {fmt::format("{} = {}", letter_of(held.quantity), held.decimal)}};
  };
  if (text.starts_with("T=") || text.starts_with("E=")) {
    const HeldValue held{text.front() == 'T' ? Quantity::period : Quantity::energy, text.substr(2)};
    static_cast<void>(numerics::extended_of(held.decimal));
    return named(with(held, after), held);
  }
  const int step = step_named(text, ", T=PERIOD or E=ENERGY");
  Place place = at_step(step);
  const Quantity quantity = better_held(place.guess);
  return named(std::move(place), {quantity, stored(quantity, step)});
}

int StoredFamily::step_named(const std::string& text, const std::string& expected) const {
  int step = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
  if (error != std::errc() || end != text.data() + text.size())
    throw core::InputError(fmt::format("expected a step of {}{}, got `{}`", _name, expected, text));
  return step;
}

StoredFamily::Named StoredFamily::of_parameter(const std::string& text, std::optional<int> after) const {
  using Hold = systems::FamilyScalars::Hold;
  using Quantity = HeldValue::Quantity;
  const std::string prefix = _parameter + "=";
  Named named;
  named.held.quantity = Quantity::parameter;
  if (text.starts_with(prefix)) {
    named.held.decimal = numerics::shortest_decimal(parameter_value(_parameter, text.substr(prefix.size())));
    named.place = with(named.held, after);
  } else {
    const int step = step_named(text, fmt::format(" or {}VALUE", prefix));
    named.held.decimal = stored(Quantity::parameter, step);
    named.place = at_step(step);
  }
  named.equations = {fmt::format("{} = {}", _parameter, named.held.decimal)};
  if (_choice.moving.hold == Hold::nothing) return named;
  const Quantity quantity = _choice.moving.hold == Hold::period ? Quantity::period : Quantity::energy;
  named.held = {quantity, stored(quantity, step_of(0))};
  named.equations.push_back(fmt::format("{} = {}", letter_of(quantity), named.held.decimal));
  return named;
}

StoredFamily::Place StoredFamily::at_arclength(double arclength) const {
  if (!_parameter.empty())
    throw core::InputError(
        fmt::format("{} runs in {}: of such families orbits can be refined, by a value or a step, "
                    "and no crossings",
                    _name, _parameter));
  return placed(arclength, _plain);
}

StoredFamily::Place StoredFamily::placed(double arclength, std::shared_ptr<const systems::System> plain) const {
  const Neighbours near = beside(arclength);
  std::size_t nearest = near.first;
  for (std::size_t n = near.first; n < near.end; ++n)
    if (std::abs(_arclengths[n] - arclength) < std::abs(_arclengths[nearest] - arclength)) nearest = n;
  std::vector<loop::Loop> loops(near.end - near.first);
  const auto at = [&](std::size_t n) -> loop::Loop& { return loops[n - near.first]; };
  const systems::Structure& structure = _system->structure();
  at(nearest) = survey::stored_loop(_atlas, _first_orbit + nearest, *_system);
  for (std::size_t n = nearest + 1; n < near.end; ++n)
    at(n) = survey::started_as(structure, survey::stored_loop(_atlas, _first_orbit + n, *_system), at(n - 1));
  for (std::size_t n = nearest; n-- > near.first;)
    at(n) = survey::started_as(structure, survey::stored_loop(_atlas, _first_orbit + n, *_system), at(n + 1));
  int cutoff = 0;
  for (const loop::Loop& loop : loops) cutoff = std::max(cutoff, loop.cutoff);
  const loop::TimeMap map = at(nearest).time_map;
  const std::span<const double> nodes(_arclengths.data() + near.first, loops.size());
  const std::vector<double> weights = numerics::lagrange_weights(nodes, arclength).value;
  loop::Loop guess = loop::with_cutoff(at(nearest), cutoff);
  guess.period = 0.0;
  std::fill(guess.modes.begin(), guess.modes.end(), 0.0);
  for (std::size_t n = 0; n < loops.size(); ++n) {
    const loop::Loop same =
        loops[n].time_map == map ? loop::with_cutoff(loops[n], cutoff) : loop::with_time_map(loops[n], map, cutoff);
    guess.period += weights[n] * same.period;
    for (std::size_t i = 0; i < guess.modes.size(); ++i) guess.modes[i] += weights[n] * same.modes[i];
  }
  guess.parameters.clear();  // those of `plain`
  guess = loop::in_standard_phase(structure, guess, _isotropy);
  for (const loop::SymmetryElement& element : _isotropy)
    if (const double defect = loop::symmetry_defect(guess, element, structure.angles); defect > symmetry_of_a_guess)
      throw core::InputError(
          fmt::format("the orbits of {} do not have its symmetry {}: they are off by {:.1e}; was the file changed?",
                      _name, element.name, defect));
  Place place;
  systems::Scales scales = _system->scales();
  scales.parameters.clear();
  place.guess = {std::move(plain), scales, loop::in_units(guess, scales), _isotropy};
  const auto after = std::lower_bound(_arclengths.begin(), _arclengths.end(), arclength);
  const auto next = std::min(static_cast<std::size_t>(after - _arclengths.begin()), _arclengths.size() - 1);
  place.first_step = step_of(next > 0 && _arclengths[next] > arclength ? next - 1 : next);
  place.last_step = step_of(next);
  return place;
}

StoredCrossing stored_crossing(const archive::Archive& atlas, std::size_t row) {
  const archive::Table& table = atlas.crossings();
  if (row >= table.rows())
    throw core::InputError(fmt::format("{} has the crossings 0 to {}, and no row {}", atlas.path().string(),
                                       static_cast<long>(table.rows()) - 1, row));
  StoredFamily family(atlas, static_cast<std::size_t>(table.integers("family")[row]));
  StoredFamily::Place place = family.at_arclength(table.reals("arclength")[row]);
  const CrossingCondition condition{atlas.crossing_kinds()[row], static_cast<int>(table.integers("sector_j")[row]),
                                    static_cast<int>(table.integers("sector_q")[row])};
  const int order = static_cast<int>(table.integers("fundamental_order")[row]);
  const loop::SymmetryGroup group(place.guess.system->structure(), place.guess.isotropy);
  if (archive::has_sector(condition.kind) && group.order() != order)
    throw core::InputError(
        fmt::format("the fundamental map has the order {} at the crossing, {} on {}: was the file changed?", order,
                    group.order(), family.name()));
  return {std::move(family), std::move(place), condition, table.reals("period")[row]};
}

}  // namespace orbweaver::refine
