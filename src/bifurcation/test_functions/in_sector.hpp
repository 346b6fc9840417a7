#pragma once

#include <algorithm>

#include "test_functions/rule.hpp"

namespace orbweaver::bifurcation {

/// A multiplier passes exp(+-2 pi i j/q).
class InSector final : public Rule {
 public:
  [[nodiscard]] std::string_view name() const override { return "sector"; }
  [[nodiscard]] bool has_sector() const override { return true; }
  [[nodiscard]] bool applies(const systems::Structure& system, std::size_t /*count*/,
                             const Sector& sector) const override {
    return system.symplectic || sector.q <= 2;
  }
  [[nodiscard]] std::vector<Bounded> factors(const systems::Structure& system, const Sector& sector,
                                             const std::vector<Bounded>& indices) const override {
    return factors_over(system, sector, indices, 0.0);
  }
  [[nodiscard]] std::vector<Bounded> factors_over(const systems::Structure& system, const Sector& sector,
                                                  const std::vector<Bounded>& indices, double size) const override {
    const double scale = std::max(system.symplectic ? 2.0 : 1.0, size);
    const double c = system.symplectic ? sector.index() : 0.5 * sector.index();
    std::vector<Bounded> out;
    for (const Bounded& index : indices) out.push_back(scaled(index, c, scale));
    return out;
  }
};

}  // namespace orbweaver::bifurcation
