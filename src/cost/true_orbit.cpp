#include "true_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/spectrum/floquet.hpp"

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

/// As many as its largest multiplier or index has before the point.
int growth_digits(const systems::System& scaled, const loop::Loop& near, const loop::Isotropy& isotropy) {
  double growth = 1.0;
  for (const std::complex<double>& value : spectrum::floquet(scaled, near, isotropy).full)
    growth = std::max(growth, std::abs(value));
  if (!std::isfinite(growth)) throw core::NumericalError("an orbit with multipliers beyond double precision");
  return static_cast<int>(std::ceil(std::log10(growth)));
}

}  // namespace

/// Held by what picks it better, or, where that does not pick it after all, by the other.
TrueOrbit::Refined TrueOrbit::refined_near(const refine::Guess& guess, const systems::System& scaled,
                                           const loop::Loop& near, const loop::Isotropy& isotropy) {
  using Quantity = refine::HeldValue::Quantity;
  const int digits = least_digits + growth_digits(scaled, near, isotropy);
  const Quantity better = refine::better_held(guess);
  const Quantity other = better == Quantity::period ? Quantity::energy : Quantity::period;
  const refine::HeldValue held = held_at(scaled, near, better);
  try {
    return {held, digits, refine::refine_orbit(guess, held, digits)};
  } catch (const core::NumericalError&) {
    const refine::HeldValue instead = held_at(scaled, near, other);
    return {instead, digits, refine::refine_orbit(guess, instead, digits)};
  }
}

namespace {

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
      _refined(refined_near(_guess, scaled, near, isotropy)),
      _fractions(even_fractions()),
      _states(in_scales(refine::states_of(_guess, _refined.orbit, _fractions))) {
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
  const Eigen::VectorXd states = in_scales(refine::states_of(_guess, _refined.orbit, orbit.fractions));
  return (in_scales(orbit.states) - states).lpNorm<Eigen::Infinity>();
}

double TrueOrbit::error_at_its_period(const refine::ShotOrbit& orbit) const {
  const refine::RefinedOrbit truth = refine::refine_orbit(
      _guess, {refine::HeldValue::Quantity::period, numerics::shortest_decimal(orbit.period)}, _refined.digits);
  const Eigen::VectorXd states = in_scales(refine::states_of(_guess, truth, orbit.fractions));
  const Eigen::VectorXd shift = velocities(states);
  Eigen::VectorXd off = in_scales(orbit.states) - states;
  off -= shift * (shift.dot(off) / shift.squaredNorm());
  return off.lpNorm<Eigen::Infinity>();
}

}  // namespace orbweaver::cost
