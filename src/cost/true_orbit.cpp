#include "true_orbit.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "orbweaver/refine/guess.hpp"

namespace orbweaver::cost {

namespace {

/// Digits of a true orbit: four more than double precision has, and those that its multipliers take over a period.
constexpr int least_digits = 20;
/// Instants at which an orbit is held against it: a few more than any orbit here has quick passages. A prime number, so
/// that no symmetry repeats them.
constexpr int instants = 61;

refine::HeldValue held_at(const systems::System& scaled, const loop::Loop& near, refine::HeldValue::Quantity quantity) {
  const double value = quantity == refine::HeldValue::Quantity::period
                           ? near.period * scaled.scales().time
                           : continuation::energy_of(scaled, near) * scaled.scales().energy();
  return {quantity, numerics::shortest_decimal(value)};
}

refine::RefinedOrbit refined(const refine::Guess& guess, const refine::HeldValue& held) {
  refine::RefinedOrbit orbit = refine::refine_orbit(guess, held, least_digits);
  const double growth = orbit.index ? numerics::log10_abs(orbit.index->value) : 0.0;
  if (growth > 1.0) orbit = refine::refine_orbit(guess, held, least_digits + static_cast<int>(std::ceil(growth)));
  return orbit;
}

/// Held by what picks it better, or, where that does not pick it after all, by the other.
refine::HeldValue held_near(const refine::Guess& guess, const systems::System& scaled, const loop::Loop& near) {
  using Quantity = refine::HeldValue::Quantity;
  const Quantity better = refine::better_held(guess);
  const refine::HeldValue held = held_at(scaled, near, better);
  try {
    static_cast<void>(refine::refine_orbit(guess, held, 1));
    return held;
  } catch (const core::NumericalError&) {
    return held_at(scaled, near, better == Quantity::period ? Quantity::energy : Quantity::period);
  }
}

std::vector<double> even_fractions() {
  std::vector<double> fractions;
  for (int n = 0; n < instants; ++n) fractions.push_back(static_cast<double>(n) / instants);
  return fractions;
}

}  // namespace

TrueOrbit::TrueOrbit(const std::shared_ptr<const systems::System>& plain, const systems::System& scaled,
                     const loop::Loop& near, const loop::Loop& neighbour, const loop::Isotropy& isotropy)
    : _scaled(scaled),
      _isotropy(isotropy),
      _guess(refine::guess_of(plain, scaled, near, isotropy)),
      _held(held_near(_guess, scaled, near)),
      _orbit(refined(_guess, _held)),
      _fractions(even_fractions()),
      _states(in_scales(refine::states_of(_guess, _orbit, _fractions))) {
  _neutral.resize(_states.size(), 2);
  _neutral.col(0) = velocities(_states);
  _neutral.col(1) = samples_of(neighbour) - samples_of(near);
  _neutral.colwise().normalize();
}

Eigen::VectorXd TrueOrbit::velocities(const Eigen::VectorXd& states) const {
  const Eigen::Index d = _scaled.dimension();
  Eigen::VectorXd out(states.size());
  for (Eigen::Index n = 0; n < states.size(); n += d) _scaled.field(1, states.data() + n, out.data() + n);
  return out;
}

Eigen::VectorXd TrueOrbit::in_scales(const std::vector<std::vector<double>>& states) const {
  const Eigen::Index d = _scaled.dimension();
  Eigen::VectorXd out(static_cast<Eigen::Index>(states.size()) * d);
  for (std::size_t n = 0; n < states.size(); ++n)
    for (std::size_t i = 0; i < states[n].size(); ++i)
      out(static_cast<Eigen::Index>(n) * d + static_cast<Eigen::Index>(i)) =
          states[n][i] / _scaled.scales().coordinate(i);
  return out;
}

Eigen::VectorXd TrueOrbit::samples_of(const loop::Loop& orbit) const {
  const loop::Loop standard = loop::in_standard_phase(_scaled.structure(), orbit, _isotropy);
  std::vector<double> all;
  for (const double fraction : _fractions) {
    const std::vector<double> state = loop::state_at(standard, fraction * standard.period);
    all.insert(all.end(), state.begin(), state.end());
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

double TrueOrbit::error_of(const loop::Loop& orbit) const {
  const Eigen::VectorXd off = samples_of(orbit) - _states;
  if (!off.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd rest = off - _neutral * _neutral.colPivHouseholderQr().solve(off);
  return rest.lpNorm<Eigen::Infinity>();
}

double TrueOrbit::error_of(const refine::ShotOrbit& orbit) const {
  const Eigen::VectorXd states = in_scales(refine::states_of(_guess, _orbit, orbit.fractions));
  return (in_scales(orbit.states) - states).lpNorm<Eigen::Infinity>();
}

double TrueOrbit::error_at_its_period(const refine::ShotOrbit& orbit) const {
  const refine::RefinedOrbit truth =
      refined(_guess, {refine::HeldValue::Quantity::period, numerics::shortest_decimal(orbit.period)});
  const Eigen::VectorXd states = in_scales(refine::states_of(_guess, truth, orbit.fractions));
  const Eigen::VectorXd shift = velocities(states);
  Eigen::VectorXd off = in_scales(orbit.states) - states;
  off -= shift * (shift.dot(off) / shift.squaredNorm());
  return off.lpNorm<Eigen::Infinity>();
}

}  // namespace orbweaver::cost
