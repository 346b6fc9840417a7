#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

namespace orbweaver::bifurcation {

/// A number and a bound on its absolute error.
struct Bounded {
  std::complex<double> value;
  double error = 0.0;
};

/// (x - c)/(scale + |x|) for |c| <= scale: then an error e of x changes it by at most 2 e/(scale + |x + e|).
inline Bounded scaled(const Bounded& x, double c, double scale) {
  const double size = std::abs(x.value);
  return {(x.value - c) / (scale + size), 2.0 * x.error / std::max(scale, scale + size - x.error)};
}

inline Bounded product(const Bounded& a, const Bounded& b) {
  return {a.value * b.value, std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error};
}

/// (a b - 1)/(1 + |a b|), also where a b is beyond double precision: there with relative numbers, 1/|a b| for 1.
inline Bounded scaled_product(const Bounded& a, const Bounded& b) {
  constexpr double huge = 1e150;
  const double size_a = std::abs(a.value);
  const double size_b = std::abs(b.value);
  if (size_a * size_b < huge) return scaled(product(a, b), 1.0, 1.0);
  const double one = 1.0 / size_a / size_b;
  const double error = a.error / size_a + b.error / size_b + a.error / size_a * (b.error / size_b);
  const std::complex<double> direction = (a.value / size_a) * (b.value / size_b);
  return {(direction - one) / (one + 1.0), 2.0 * error / std::max(one, one + 1.0 - error)};
}

template <class Factor>
std::vector<Bounded> over_pairs(const std::vector<Bounded>& indices, const Factor& factor) {
  std::vector<Bounded> factors;
  for (std::size_t i = 0; i < indices.size(); ++i)
    for (std::size_t j = i + 1; j < indices.size(); ++j) factors.push_back(factor(indices[i], indices[j]));
  return factors;
}

/// Of the pair whose factor is the smallest (`factors` over pairs of `indices`): the sum of the two.
inline Bounded sum_at_smallest(const std::vector<Bounded>& indices, const std::vector<Bounded>& factors) {
  const auto sums = over_pairs(
      indices, [](const Bounded& a, const Bounded& b) { return Bounded{a.value + b.value, a.error + b.error}; });
  const auto smallest = std::min_element(factors.begin(), factors.end(), [](const Bounded& a, const Bounded& b) {
    return std::abs(a.value) < std::abs(b.value);
  });
  const Bounded& sum = sums[static_cast<std::size_t>(smallest - factors.begin())];
  return {sum.value.real(), sum.error};
}

/// Whether |x| is at most `most`. None where x is known too badly.
inline std::optional<bool> is_within(const Bounded& x, double most) {
  const double beyond = std::abs(x.value) - most;
  if (std::abs(beyond) <= x.error) return std::nullopt;
  return beyond < 0.0;
}

}  // namespace orbweaver::bifurcation
