#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/systems/structure.hpp"
#include "test_functions/bounded.hpp"

namespace orbweaver::bifurcation {

/// One kind of test function: the signed mean (test_functions.cpp) of factors that the stability indices, or the
/// multipliers of a dissipative system, give. Each kind is a header beside this one, named in rules.cpp.
class Rule {
 public:
  Rule() = default;
  Rule(const Rule&) = delete;
  Rule& operator=(const Rule&) = delete;
  Rule(Rule&&) = delete;
  Rule& operator=(Rule&&) = delete;
  virtual ~Rule() = default;

  /// As the archive's crossings are called where the function has no sector.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Whether the function is of one sector, in which families are born.
  [[nodiscard]] virtual bool has_sector() const { return false; }
  /// Whether it is a function of such systems, with so many indices, in that sector.
  [[nodiscard]] virtual bool applies(const systems::Structure& system, std::size_t count,
                                     const Sector& sector) const = 0;
  /// Each within [-1, 1], and of one sign where the indices are apart from what the function is for.
  [[nodiscard]] virtual std::vector<Bounded> factors(const systems::Structure& system, const Sector& sector,
                                                     const std::vector<Bounded>& indices) const = 0;
  /// The same with factors that are within [-0.5, 0.5] for indices up to `size`, which is larger than theirs near a
  /// zero: of the same signs, and nearly linear where those above are -1 or 1 all the way to it. Those above for a kind
  /// that has none.
  [[nodiscard]] virtual std::vector<Bounded> factors_over(const systems::Structure& system, const Sector& sector,
                                                          const std::vector<Bounded>& indices, double /*size*/) const {
    return factors(system, sector, indices);
  }
  /// Whether a zero is what the function is for, none where error bounds leave that open; `tangency`: it touches zero
  /// there.
  [[nodiscard]] virtual std::optional<bool> is_event(const std::vector<Bounded>& /*indices*/,
                                                     const std::vector<Bounded>& /*factors*/, bool /*tangency*/) const {
    return true;
  }
};

}  // namespace orbweaver::bifurcation
