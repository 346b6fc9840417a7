#include "orbweaver/bifurcation/test_functions.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "test_functions/rules.hpp"

namespace orbweaver::bifurcation {

namespace {

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

/// Roundings of a factor: four operations.
constexpr double roundings_a_factor = 4.0 * std::numeric_limits<double>::epsilon();

/// The harmonic mean of `modulus` of the factors, 0 where one is not above 0.
template <class Modulus>
double harmonic_mean(const std::vector<Bounded>& factors, const Modulus& modulus) {
  double inverse = 0.0;
  for (const Bounded& factor : factors) inverse += 1.0 / std::max(0.0, modulus(std::abs(factor.value), factor.error));
  return static_cast<double>(factors.size()) / inverse;
}

/// The harmonic mean of the moduli with the sign of the product, which is real: smooth, and near a zero of one factor
/// proportional to that one. A product of many factors would be far below each of them: its zeros in pairs would not be
/// told from what it is between them.
Reading signed_mean(const std::vector<Bounded>& factors) {
  if (factors.size() == 1) return {factors.front().value.real(), factors.front().error};
  std::complex<double> direction{1.0, 0.0};
  for (const Bounded& factor : factors) {
    const double size = std::abs(factor.value);
    if (std::isnan(size + factor.error)) return {size + factor.error, std::numeric_limits<double>::infinity()};
    if (size > 0.0) direction *= factor.value / size;
  }
  const double size = harmonic_mean(factors, [](double modulus, double) { return modulus; });
  const double least = harmonic_mean(factors, [](double modulus, double error) { return modulus - error; });
  const double most = harmonic_mean(factors, [](double modulus, double error) { return modulus + error; });
  if (least > 0.0) return {std::copysign(size, direction.real()), std::max(size - least, most - size)};
  // Of factors within their bounds the signs are open.
  const double flipped = harmonic_mean(
      factors, [](double modulus, double error) { return modulus > error ? modulus + error : error - modulus; });
  return {std::copysign(size, direction.real()), std::max(size + flipped, most - size)};
}

const Rule& checked_rule(const TestFunction& function, const systems::Structure& system) {
  const Rule& rule = rule_of(function.kind);
  if (!rule.applies(system, count_of(system), function.sector))
    throw core::MisuseError(fmt::format("the test function {} is none of such a system's", rule.name()));
  return rule;
}

/// Of a stability index of modulus up to `near_circle`: a hundred times what the worst family of a survey with slow and
/// fast motions 6 times apart has (m2 = 1e-6), a tenth of the best with 2000 times (m2 = 1e6).
constexpr double told_to = 1e-4;
constexpr double near_circle = 3.0;

/// How many of several indices are above the function's place: none passes it unseen while all are
/// real.
double indices_above(const TestFunction& function, const systems::Structure& system,
                     const spectrum::Stability& stability) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Bounded> indices = indices_of(system, stability);
  if (indices.size() < 2) return unknown;
  int above = 0;
  for (const Bounded& factor : checked_rule(function, system).factors(system, function.sector, indices)) {
    // Two that are equal by symmetry are a complex pair to rounding.
    if (!(std::abs(factor.value.imag()) <= factor.error) || !(std::abs(factor.value.real()) > factor.error))
      return unknown;
    if (factor.value.real() > 0.0) ++above;
  }
  return above;
}

}  // namespace

bool are_decided(const spectrum::Stability& stability) {
  for (std::size_t i = 0; i < stability.fundamental.size(); ++i)
    if (std::abs(stability.fundamental[i]) <= near_circle && stability.fundamental_error[i] > told_to) return false;
  return true;
}

bool is_elliptic(const spectrum::Stability& stability) {
  return stability.fundamental.size() == 1 &&
         std::abs(stability.fundamental[0].real()) + stability.fundamental_error[0] < 2.0;
}

bool is_isolated(const spectrum::Stability& stability) {
  for (std::size_t i = 0; i < stability.fundamental.size(); ++i)
    if (std::abs(stability.fundamental[i] - 2.0) <= error_margin * stability.fundamental_error[i]) return false;
  return true;
}

int Reading::sign() const {
  if (!(std::abs(value) > error)) return 0;
  return value > 0.0 ? 1 : -1;
}

int Reading::clear_sign() const { return Reading{value, error_margin * error}.sign(); }

std::string_view name_of(TestFunction::Kind kind) { return rule_of(kind).name(); }
bool has_sector(TestFunction::Kind kind) { return rule_of(kind).has_sector(); }

std::vector<TestFunction> test_functions(const systems::Structure& system, int fundamental_order, int subharmonics) {
  std::vector<TestFunction> functions;
  const std::size_t count = count_of(system);
  if (count == 0) return functions;
  for (int n = 0; n <= static_cast<int>(last_of(TestFunction::Kind{})); ++n) {
    const auto kind = static_cast<TestFunction::Kind>(n);
    const Rule& rule = rule_of(kind);
    const std::vector<Sector> places =
        rule.has_sector() ? sectors(fundamental_order, subharmonics) : std::vector<Sector>(1);
    for (const Sector& sector : places)
      if (rule.applies(system, count, sector)) functions.push_back({kind, sector});
  }
  return functions;
}

Reading evaluate(const TestFunction& function, const systems::Structure& system, const spectrum::Stability& stability) {
  const Rule& rule = checked_rule(function, system);
  const std::vector<Bounded> factors = rule.factors(system, function.sector, indices_of(system, stability));
  Reading reading = signed_mean(factors);
  reading.error += roundings_a_factor * static_cast<double>(factors.size());
  return reading;
}

double value_over(const TestFunction& function, const systems::Structure& system, const spectrum::Stability& stability,
                  double size) {
  const Rule& rule = checked_rule(function, system);
  return signed_mean(rule.factors_over(system, function.sector, indices_of(system, stability), size)).value;
}

ZerosPassed zeros_passed(const TestFunction& function, const systems::Structure& system,
                         const spectrum::Stability& stability) {
  ZerosPassed passed{function};
  passed.outside = outside_circle(system, stability);
  if (!system.symplectic || !has_sector(function.kind)) return passed;
  if (std::isnan(stability.turns)) {
    passed.number = indices_above(function, system, stability);
    return passed;
  }
  const double place = static_cast<double>(function.sector.j) / function.sector.q;
  const double index = stability.fundamental.front().real();
  const bool has_opened = function.sector.q == 1 ? index >= 2.0 : index <= -2.0;
  if (function.sector.q > 2)
    passed.number = std::floor(stability.turns - place) + std::floor(stability.turns + place);
  else if (!has_opened)
    passed.number = std::floor(stability.turns - place);
  return passed;
}

int zeros_between(const ZerosPassed& from, const ZerosPassed& to) {
  if (!from.outside || !to.outside) {
    const double change = std::abs(to.number - from.number);
    return std::isnan(change) ? 0 : static_cast<int>(change);
  }
  const CirclePassages passages = least_passages(*from.outside, *to.outside);
  if (!has_sector(to.function.kind)) return passages.as_pairs;
  return to.function.sector.q == 1 ? passages.at_one : passages.at_minus_one;
}

double torus_sum(const systems::Structure& system, const spectrum::Stability& stability) {
  const TestFunction torus{TestFunction::Kind::torus, {}};
  const std::vector<Bounded> indices = indices_of(system, stability);
  return sum_at_smallest(indices, checked_rule(torus, system).factors(system, torus.sector, indices)).value.real();
}

std::optional<bool> is_event(const TestFunction& function, const systems::Structure& system,
                             const spectrum::Stability& stability, bool tangency) {
  const Rule& rule = checked_rule(function, system);
  const std::vector<Bounded> indices = indices_of(system, stability);
  return rule.is_event(indices, rule.factors(system, function.sector, indices), tangency);
}

}  // namespace orbweaver::bifurcation
