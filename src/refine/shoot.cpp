#include "orbweaver/refine/shoot.hpp"

#include <utility>

#include "conditioned_orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/taylor/flow.hpp"

namespace orbweaver::refine {

namespace {

using numerics::Extended;

/// A few nodes of many.
void thin(ShootingSetup& setup, int segments) {
  const std::size_t most = setup.segments();
  const auto wanted = static_cast<std::size_t>(segments);
  core::require(wanted <= most, "shooting takes no more segments than its setup has");
  std::vector<double> fractions;
  std::vector<std::vector<double>> nodes;
  for (std::size_t n = 0; n <= wanted; ++n) {
    fractions.push_back(setup.fractions[n * most / wanted]);
    nodes.push_back(setup.guess.nodes[n * most / wanted]);
  }
  setup.fractions = std::move(fractions);
  setup.guess.nodes = std::move(nodes);
}

}  // namespace

ShotOrbit shoot(const Guess& guess, const HeldValue& value, int segments) {
  ShootingSetup setup(conservative_formulas(*guess.system), guess.system->structure(), guess.scales, guess.loop,
                      guess.isotropy);
  if (segments > 0) thin(setup, segments);
  ConditionedOrbit orbit(setup);
  Held held;
  held.kind = value.quantity == HeldValue::Quantity::period ? Held::Kind::period : Held::Kind::energy;
  held.decimal = value.decimal;
  const Points<double> found = orbit.converge(setup.guess, held);
  return {setup.fractions, found.nodes, found.period};
}

std::vector<std::vector<double>> states_of(const Guess& guess, const RefinedOrbit& orbit,
                                           const std::vector<double>& fractions) {
  const numerics::WorkingDigits working(orbit.working_digits);
  const systems::Formulas formulas = refinable_formulas(*guess.system);
  std::vector<Extended> parameters;
  for (const double value : formulas.values)
    parameters.push_back(numerics::extended_of(numerics::shortest_decimal(value)));
  taylor::FlowOptions options;
  options.digits = orbit.working_digits;
  options.scales = guess.scales.coordinates;
  taylor::Flow<Extended> flow(formulas, parameters, options);
  std::vector<Extended> state;
  for (const Number& number : orbit.state) state.push_back(number.value);
  std::vector<std::vector<double>> states;
  double reached = 0.0;
  for (const double fraction : fractions) {
    core::require(fraction >= reached, "the instants increase");
    if (fraction > reached)
      flow.advance(state, Extended((Extended(fraction) - Extended(reached)) * orbit.period.value));
    reached = fraction;
    std::vector<double>& narrow = states.emplace_back();
    for (const Extended& x : state) narrow.push_back(static_cast<double>(x));
  }
  return states;
}

}  // namespace orbweaver::refine
