#pragma once

#include <algorithm>
#include <complex>

#include "test_functions/rule.hpp"

namespace orbweaver::bifurcation {

/// Two pairs of multipliers meet and leave the unit circle, or come back to it.
class Krein final : public Rule {
 public:
  [[nodiscard]] std::string_view name() const override { return "krein"; }
  [[nodiscard]] bool applies(const systems::Structure& system, std::size_t count,
                             const Sector& /*sector*/) const override {
    return system.symplectic && count >= 2;
  }
  [[nodiscard]] std::vector<Bounded> factors(const systems::Structure& /*system*/, const Sector& /*sector*/,
                                             const std::vector<Bounded>& indices) const override {
    return over_pairs(indices, [](const Bounded& a, const Bounded& b) {
      const double larger = std::max(std::abs(a.value), std::abs(b.value));
      if (larger < huge) return distance_squared(a, b, scale);
      const auto part = [larger](const Bounded& x) { return Bounded{x.value / larger, x.error / larger}; };
      return distance_squared(part(a), part(b), 0.0);
    });
  }
  [[nodiscard]] std::optional<bool> is_event(const std::vector<Bounded>& indices, const std::vector<Bounded>& factors,
                                             bool tangency) const override {
    if (tangency) return false;
    return is_within(sum_at_smallest(indices, factors), largest_sum);
  }

 private:
  /// |k| <= 2 on the unit circle: the denominator begins at 2^2 + 2^2, and pairs that meet there have |k_i + k_j| <= 4
  /// (docs/mathematics.md, "Test functions").
  static constexpr double scale = 8.0;
  static constexpr double largest_sum = 4.0;

  /// Squares of larger indices would overflow; beside theirs `scale` is nothing.
  static constexpr double huge = 1e150;

  static Bounded distance_squared(const Bounded& a, const Bounded& b, double least) {
    const std::complex<double> difference = a.value - b.value;
    const double error = a.error + b.error;
    const double below = least + 2.0 * std::norm(a.value) + 2.0 * std::norm(b.value);
    const double below_error =
        2.0 * a.error * (2.0 * std::abs(a.value) + a.error) + 2.0 * b.error * (2.0 * std::abs(b.value) + b.error);
    const std::complex<double> value = difference * difference / below;
    const double above_error = error * (2.0 * std::abs(difference) + error);
    return {value, (above_error + std::abs(value) * below_error) / std::max(least, below - below_error)};
  }
};

}  // namespace orbweaver::bifurcation
