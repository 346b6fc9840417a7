#include "orbit_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

constexpr double largest_error = 1e-3;

}  // namespace

// The file does not say which of the two a complex value is: multipliers, or indices of two or more symplectic pairs.
bool holds_multipliers(const archive::Archive& atlas) {
  if (!archive::has_complex_stability(atlas.header())) return false;
  if (atlas.header().pairs == 1) return true;
  return !has_energies(atlas);
}

OrbitStability::OrbitStability(const archive::Archive& atlas)
    : _values(atlas.orbits().reals("stability")),
      _errors(atlas.orbits().reals("stability_error")),
      _log_volumes(atlas.orbits().reals("log_volume")),
      _pairs(static_cast<std::size_t>(atlas.header().pairs)),
      _complex(archive::has_complex_stability(atlas.header())),
      _multipliers(holds_multipliers(atlas)),
      _neutral(_multipliers && has_energies(atlas) ? 1 : 0) {}

std::optional<bool> OrbitStability::of(std::size_t orbit) const {
  const bool has_error = !std::isnan(_errors[orbit]);
  const double error = has_error ? _errors[orbit] : 0.0;
  if (_pairs == 0) return std::nullopt;
  bool stable = true;
  bool decided = error <= largest_error;
  int neutral = _neutral;
  for (std::size_t pair = 0; pair < _pairs; ++pair) {
    const std::complex<double> k = value(orbit, pair);
    if (std::isnan(k.real()) || std::isnan(k.imag())) return by_volume(orbit);
    const double beyond = _multipliers ? std::abs(k) - 1.0 : std::max(std::abs(k.real()) - 2.0, std::abs(k.imag()));
    stable = stable && beyond <= error;
    const bool is_inside = !has_error || (_multipliers ? beyond : std::abs(k.real()) - 2.0) < -error;
    decided = decided && (is_inside || neutral-- > 0);
  }
  return stable && !decided ? std::nullopt : std::optional<bool>(stable);
}

// A single multiplier is all of the volume's change; where it is beyond double precision's range its logarithm is not.
std::optional<bool> OrbitStability::by_volume(std::size_t orbit) const {
  const double logarithm = _log_volumes[orbit];
  if (!_multipliers || _pairs != 1 || !(std::abs(logarithm) > largest_error)) return std::nullopt;
  return logarithm < 0.0;
}

double OrbitStability::log10_growth(std::size_t orbit) const {
  double growth = -std::numeric_limits<double>::infinity();
  for (std::size_t pair = 0; pair < _pairs; ++pair) {
    const std::complex<double> k = value(orbit, pair);
    if (std::isnan(k.real()) || std::isnan(k.imag()))
      return _multipliers && _pairs == 1 ? _log_volumes[orbit] / std::numbers::ln10 : archive::not_computed;
    // mu + 1/mu = k: the root that does not cancel, and its inverse.
    const std::complex<double> root = std::sqrt(k - 2.0) * std::sqrt(k + 2.0);
    const std::complex<double> mu =
        _multipliers ? k : 0.5 * (std::abs(k + root) > std::abs(k - root) ? k + root : k - root);
    growth = std::max(growth, std::log10(std::abs(mu)));
  }
  return growth;
}

std::complex<double> OrbitStability::value(std::size_t orbit, std::size_t pair) const {
  const std::size_t at = orbit * _pairs + pair;
  return _complex ? std::complex<double>(_values[2 * at], _values[2 * at + 1]) : _values[at];
}

}  // namespace orbweaver::report
