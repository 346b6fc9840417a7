#include "orbweaver/bifurcation/test_functions.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

namespace {

using Complex = std::complex<double>;
using Kind = TestFunction::Kind;

struct Bounded {
  Complex value;
  double error = 0.0;
};

/// Nontrivial stability indices or multipliers of an orbit.
std::size_t count_of(const systems::Structure& system) {
  return static_cast<std::size_t>(system.pairs() - (system.conservative() && !system.symplectic ? 1 : 0));
}

std::vector<Bounded> indices_of(const systems::Structure& system, const spectrum::Stability& stability) {
  const std::size_t count = count_of(system);
  if (stability.fundamental.size() != static_cast<std::size_t>(system.pairs()) ||
      stability.fundamental_error.size() != stability.fundamental.size())
    throw core::MisuseError(fmt::format("test functions: expected {} multipliers with error bounds, got {} with {}",
                                        system.pairs(), stability.fundamental.size(),
                                        stability.fundamental_error.size()));
  std::vector<Bounded> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = {stability.fundamental[i], stability.fundamental_error[i]};
  return indices;
}

/// Roundings of a product, a factor: four operations each.
constexpr double roundings_a_factor = 4.0 * std::numeric_limits<double>::epsilon();
/// |k| <= 2 on the unit circle: krein's denominator begins at 2^2 + 2^2, and pairs that meet there have
/// |k_i + k_j| <= 4; multipliers with mu_i mu_j = 1 that are not real have |mu_i + mu_j| <= 2 (docs/mathematics.md,
/// "Test functions").
constexpr double krein_scale = 8.0;
constexpr double largest_krein_sum = 4.0;
constexpr double largest_torus_sum = 2.0;

/// (x - c)/(scale + |x|) for |c| <= scale: then an error e of x changes it by at most 2 e/(scale + |x + e|).
Bounded scaled(const Bounded& x, double c, double scale) {
  const double size = std::abs(x.value);
  return {(x.value - c) / (scale + size), 2.0 * x.error / std::max(scale, scale + size - x.error)};
}

Bounded distance_squared(const Bounded& a, const Bounded& b) {
  const Complex difference = a.value - b.value;
  const double error = a.error + b.error;
  const double below = krein_scale + 2.0 * std::norm(a.value) + 2.0 * std::norm(b.value);
  const double below_error =
      2.0 * a.error * (2.0 * std::abs(a.value) + a.error) + 2.0 * b.error * (2.0 * std::abs(b.value) + b.error);
  const Complex value = difference * difference / below;
  const double above_error = error * (2.0 * std::abs(difference) + error);
  return {value, (above_error + std::abs(value) * below_error) / std::max(krein_scale, below - below_error)};
}

Bounded product(const Bounded& a, const Bounded& b) {
  return {a.value * b.value, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error};
}

template <class Factor>
std::vector<Bounded> over_pairs(const std::vector<Bounded>& indices, const Factor& factor) {
  std::vector<Bounded> factors;
  for (std::size_t i = 0; i < indices.size(); ++i)
    for (std::size_t j = i + 1; j < indices.size(); ++j) factors.push_back(factor(indices[i], indices[j]));
  return factors;
}

std::vector<Bounded> factors_of(const TestFunction& function, const systems::Structure& system,
                                const std::vector<Bounded>& indices) {
  if (function.kind == Kind::krein) return over_pairs(indices, distance_squared);
  if (function.kind == Kind::torus)
    return over_pairs(indices, [](const Bounded& a, const Bounded& b) { return scaled(product(a, b), 1.0, 1.0); });
  const double scale = system.symplectic ? 2.0 : 1.0;
  const double c = system.symplectic ? function.sector.index() : 0.5 * function.sector.index();
  std::vector<Bounded> factors;
  for (const Bounded& index : indices) factors.push_back(scaled(index, c, scale));
  return factors;
}

void check_listed(const TestFunction& function, const systems::Structure& system) {
  core::require(function.kind != Kind::krein || system.symplectic, "krein is a test function of symplectic systems");
  core::require(function.kind != Kind::torus || !system.symplectic, "torus is a test function of dissipative systems");
  core::require(function.kind != Kind::sector || system.symplectic || function.sector.q <= 2,
                "dissipative systems have test functions for q = 1 and 2 only");
}

}  // namespace

int Reading::sign() const {
  if (!(std::abs(value) > error)) return 0;
  return value > 0.0 ? 1 : -1;
}

std::vector<TestFunction> test_functions(const systems::Structure& system, int fundamental_order, int subharmonics) {
  std::vector<TestFunction> functions;
  const std::size_t count = count_of(system);
  if (count == 0) return functions;
  for (const Sector& sector : sectors(fundamental_order, subharmonics))
    if (system.symplectic || sector.q <= 2) functions.push_back({Kind::sector, sector});
  if (count >= 2) functions.push_back({system.symplectic ? Kind::krein : Kind::torus, {}});
  return functions;
}

Reading evaluate(const TestFunction& function, const systems::Structure& system, const spectrum::Stability& stability) {
  check_listed(function, system);
  const std::vector<Bounded> factors = factors_of(function, system, indices_of(system, stability));
  Bounded result{1.0, 0.0};
  for (const Bounded& factor : factors) result = product(result, factor);
  const double rounding = roundings_a_factor * static_cast<double>(factors.size());
  return {result.value.real(), result.error + rounding};
}

bool is_event(const TestFunction& function, const systems::Structure& system, const spectrum::Stability& stability,
              bool tangency) {
  check_listed(function, system);
  if (function.kind == Kind::sector) return true;
  const std::vector<Bounded> indices = indices_of(system, stability);
  const std::vector<Bounded> factors = factors_of(function, system, indices);
  const auto sums = over_pairs(indices, [](const Bounded& a, const Bounded& b) { return Bounded{a.value + b.value}; });
  const auto vanishing = std::min_element(factors.begin(), factors.end(), [](const Bounded& a, const Bounded& b) {
    return std::abs(a.value) < std::abs(b.value);
  });
  const double sum = sums[static_cast<std::size_t>(vanishing - factors.begin())].value.real();
  if (function.kind == Kind::krein) return !tangency && std::abs(sum) <= largest_krein_sum;
  return std::abs(sum) <= largest_torus_sum;
}

}  // namespace orbweaver::bifurcation
