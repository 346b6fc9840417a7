#include "verify/table_rules.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::survey {

namespace {

/// Orbits on either side through which dW and dE are taken, and on either side for the estimate of its error.
constexpr std::size_t neighbours = 3;
/// Of that estimate, and of T dE where nothing is left of it: what the columns' rounding leaves of a derivative.
constexpr double times_estimate = 10.0;
constexpr double derivative_rounding = 1e-6;
/// An action or an energy is stored to this many eps of itself.
constexpr double digits_lost = 4.0;

class TableRules {
 public:
  TableRules(const VerifiedAtlas& atlas, Findings& findings)
      : _atlas(atlas), _archive(atlas.archive()), _findings(findings) {}

  void run() {
    header();
    families();
    orbits();
    crossings();
    sections();
    // Along a family in a parameter dW is not T dE alone.
    if (_atlas.system()->structure().conservative() && _atlas.system()->family_scalars().free.empty())
      for (std::size_t n = 0; n < _atlas.tree().families.size(); ++n) action_along(n);
  }

 private:
  [[nodiscard]] Claims of(const char* table, std::size_t row) {
    return {_findings, table, static_cast<std::int64_t>(row)};
  }

  void header() {
    const archive::Header& header = _archive.header();
    if (header.system.empty()) return;  // before there were any
    Claims claims(_findings, "", -1);
    claims.expect(header.system == _atlas.scene().system.name, "system",
                  fmt::format("is {}; the scene says {}", header.system, _atlas.scene().system.name));
    claims.expect(header.effects == _atlas.scene().system.effects, "effects", "are not those of the scene");
    std::size_t n = 0;
    for (const auto& [name, value] : _atlas.system()->parameters()) {
      const bool there = n < header.parameter_names.size();
      claims.expect(there && header.parameter_names[n] == name && header.parameter_values[n] == value,
                    "parameter_values", fmt::format("of {} is not the scene's {:.17g}", name, value));
      ++n;
    }
  }

  void families() {
    const archive::Table& table = _archive.families();
    const archive::Table& crossings = _archive.crossings();
    for (std::size_t row = 0; row < table.rows(); ++row) {
      Claims claims = of("families", row);
      const auto index = [&](const char* column) { return table.integers(column)[row]; };
      const std::int64_t parent = index("parent");
      const std::int64_t born = index("crossing");
      claims.expect((parent < 0) == (born < 0) && parent < static_cast<std::int64_t>(row), "parent",
                    fmt::format("is {}, with crossing {}", parent, born));
      if (born >= 0) {
        const auto at = static_cast<std::size_t>(born);
        claims.expect(crossings.integers("family")[at] == parent, "crossing",
                      fmt::format("is {}, which lies on family {} and not on the parent {}", born,
                                  crossings.integers("family")[at], parent));
        claims.expect(crossings.integers("multiplicity")[at] == index("multiplicity"), "multiplicity",
                      fmt::format("is {}; that of its crossing is {}", index("multiplicity"),
                                  crossings.integers("multiplicity")[at]));
      } else {
        claims.expect(index("multiplicity") == 1, "multiplicity",
                      fmt::format("is {}; a family without a parent has 1", index("multiplicity")));
      }
      const std::int64_t end = index("end_crossing");
      claims.expect((end < 0) == (index("end_family") < 0), "end_family",
                    fmt::format("is {}, with end_crossing {}", index("end_family"), end));
      if (end >= 0)
        claims.expect(crossings.integers("family")[static_cast<std::size_t>(end)] == index("end_family"),
                      "end_crossing",
                      fmt::format("is {}, which lies on family {} and not on {}", end,
                                  crossings.integers("family")[static_cast<std::size_t>(end)], index("end_family")));
      claims.expect(!table.texts("end_reason")[row].empty(), "end_reason", "is empty");
    }
  }

  void orbits() {
    const archive::Table& table = _archive.orbits();
    std::int64_t modes = 0;
    std::int64_t maps = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      Claims claims = of("orbits", row);
      claims.expect(table.integers("modes_begin")[row] == modes, "modes_begin",
                    fmt::format("is {}; the orbit before ends at {}", table.integers("modes_begin")[row], modes));
      claims.expect(table.integers("time_map_begin")[row] == maps, "time_map_begin",
                    fmt::format("is {}; the orbit before ends at {}", table.integers("time_map_begin")[row], maps));
      modes = table.integers("modes_begin")[row] + table.integers("modes_count")[row];
      maps = table.integers("time_map_begin")[row] + table.integers("time_map_count")[row];
      if (row == 0 || table.integers("family")[row] != table.integers("family")[row - 1]) continue;
      claims.expect(table.integers("step")[row] == table.integers("step")[row - 1] + 1, "step",
                    fmt::format("is {} after {}", table.integers("step")[row], table.integers("step")[row - 1]));
      claims.expect(
          table.reals("arclength")[row] > table.reals("arclength")[row - 1], "arclength",
          fmt::format("is {:.12g} after {:.12g}", table.reals("arclength")[row], table.reals("arclength")[row - 1]));
    }
    Claims whole(_findings, "orbits", -1);
    whole.expect(static_cast<std::uint64_t>(modes) == _archive.mode_values(), "modes_count",
                 fmt::format("adds up to {} of {} values in /modes", modes, _archive.mode_values()));
  }

  void crossings() {
    const archive::Table& table = _archive.crossings();
    const auto place = [&](std::size_t row) {
      return std::tuple(table.integers("family")[row], table.reals("arclength")[row]);
    };
    for (std::size_t row = 1; row < table.rows(); ++row)
      of("crossings", row).expect(place(row - 1) <= place(row), "arclength", "is not in order");
    for (std::size_t row = 0; row < table.rows(); ++row)
      of("crossings", row)
          .expect(_archive.crossing_kinds()[row] != archive::CrossingKind::unknown, "kind",
                  fmt::format("is '{}', which is not known here", table.texts("kind")[row]));
  }

  void sections() {
    const archive::Table& table = _archive.sections();
    for (std::size_t row = 0; row < table.rows(); ++row) {
      Claims claims = of("sections", row);
      const auto orbit = static_cast<std::size_t>(table.integers("orbit")[row]);
      const double time = table.reals("time")[row];
      claims.expect(time >= 0.0 && time <= _archive.orbits().reals("period")[orbit], "time",
                    fmt::format("is {:.12g} in a period of {:.12g}", time, _archive.orbits().reals("period")[orbit]));
      if (row == 0) continue;
      const auto before = std::tuple(table.integers("orbit")[row - 1], table.reals("time")[row - 1]);
      claims.expect(before <= std::tuple(table.integers("orbit")[row], time), "orbit", "is not in order");
    }
  }

  /// dW/dx = T dE/dx, both as polynomials through seven neighbours in x; the error is taken from those through five.
  /// The energy may turn, so the gap is held against T times the greatest slope of the energy among the seven; where it
  /// comes to an end, against the last digits of what is stored.
  void action_along(std::size_t n) {
    const TreeFamily& family = _atlas.tree().families[n];
    const archive::Table& orbits = _archive.orbits();
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < family.orbits(); ++i)
      if (!_atlas.is_requested(family.first_orbit + i)) rows.push_back(family.first_orbit + i);
    for (std::size_t at = neighbours; at + neighbours < rows.size(); ++at) {
      const std::size_t row = rows[at];
      double least = std::numeric_limits<double>::infinity();
      for (const char* variable : {"arclength", "period"}) {
        const auto& x = orbits.reals(variable);
        bool grows = true;
        for (std::size_t m = at - neighbours; m < at + neighbours; ++m) grows = grows && x[rows[m + 1]] > x[rows[m]];
        if (!grows) continue;
        const auto slope_weights = [&](std::size_t reach) {
          std::vector<double> nodes;
          for (std::size_t m = at - reach; m <= at + reach; ++m) nodes.push_back(x[rows[m]]);
          return numerics::lagrange_weights(nodes, x[row]).slope;
        };
        const auto gap = [&](std::size_t reach) {
          const std::vector<double> weights = slope_weights(reach);
          double sum = 0.0;
          for (std::size_t m = 0; m < weights.size(); ++m)
            sum += weights[m] * (orbits.reals("action")[rows[at - reach + m]] - orbits.reals("action")[row] -
                                 orbits.reals("period")[row] *
                                     (orbits.reals("energy")[rows[at - reach + m]] - orbits.reals("energy")[row]));
          return sum / orbits.reals("period")[row];
        };
        double last_digits = 0.0;
        for (const double weight : slope_weights(neighbours))
          last_digits += std::abs(weight) * digits_lost * std::numeric_limits<double>::epsilon() *
                         (std::abs(orbits.reals("action")[row]) / orbits.reals("period")[row] +
                          std::abs(orbits.reals("energy")[row]));
        double slope = 0.0;
        for (std::size_t m = at - neighbours; m < at + neighbours; ++m)
          slope = std::max(slope, std::abs((orbits.reals("energy")[rows[m + 1]] - orbits.reals("energy")[rows[m]]) /
                                           (x[rows[m + 1]] - x[rows[m]])));
        const double best = std::abs(gap(neighbours));
        const double error =
            std::abs(gap(neighbours - 1) - gap(neighbours)) + std::abs(gap(neighbours - 2) - gap(neighbours - 1));
        least = std::min(least, best / (times_estimate * error + derivative_rounding * slope + last_digits));
      }
      if (std::isfinite(least))
        of("orbits", row).below("dW/dE", least, 1.0, "dW/dE - T, in parts of what the steps leave,");
    }
  }

  const VerifiedAtlas& _atlas;
  const archive::Archive& _archive;
  Findings& _findings;
};

}  // namespace

void check_tables(const VerifiedAtlas& atlas, Findings& findings) { TableRules(atlas, findings).run(); }

}  // namespace orbweaver::survey
