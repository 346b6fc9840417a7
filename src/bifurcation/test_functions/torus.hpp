#pragma once

#include "test_functions/rule.hpp"

namespace orbweaver::bifurcation {

/// A complex pair of a dissipative system's multipliers passes the unit circle.
class Torus final : public Rule {
 public:
  [[nodiscard]] std::string_view name() const override { return "torus"; }
  [[nodiscard]] bool applies(const systems::Structure& system, std::size_t count,
                             const Sector& /*sector*/) const override {
    return !system.symplectic && count >= 2;
  }
  [[nodiscard]] std::vector<Bounded> factors(const systems::Structure& /*system*/, const Sector& /*sector*/,
                                             const std::vector<Bounded>& indices) const override {
    return over_pairs(indices, scaled_product);
  }
  [[nodiscard]] std::optional<bool> is_event(const std::vector<Bounded>& indices, const std::vector<Bounded>& factors,
                                             bool /*tangency*/) const override {
    return is_within(sum_at_smallest(indices, factors), largest_sum);
  }

 private:
  /// Multipliers with mu_i mu_j = 1 that are not real have |mu_i + mu_j| <= 2.
  static constexpr double largest_sum = 2.0;
};

}  // namespace orbweaver::bifurcation
