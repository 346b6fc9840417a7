#include "tree_problems.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "orbweaver/survey/tree/family_end.hpp"

namespace orbweaver::test {

namespace {

using archive::Archive;
using archive::Table;

constexpr double period_tolerance = 0.05;
constexpr double energy_tolerance = 0.05;

struct Rows {
  std::size_t begin;
  std::size_t end;
};

class Tree {
 public:
  Tree(const Archive& atlas, std::vector<std::string>& problems)
      : _atlas(atlas),
        _families(atlas.families()),
        _orbits(atlas.orbits()),
        _crossings(atlas.crossings()),
        _problems(problems) {}

  void check(const TreeOptions& options) {
    check_names();
    check_ends(options.failures);
    check_base_families(options.base_families);
    for (std::size_t family = 0; family < _families.rows(); ++family) {
      check_ancestors(family);
      check_birth(family);
      check_death(family);
      check_steps(family);
    }
    for (std::size_t crossing = 0; crossing < _crossings.rows(); ++crossing) {
      check_place(crossing);
      check_location(crossing);
    }
  }

 private:
  template <class... Values>
  void expect(bool condition, fmt::format_string<Values...> text, Values&&... values) {
    if (!condition) _problems.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  [[nodiscard]] std::int64_t at(const Table& table, const char* column, std::size_t row) const {
    return table.integers(column)[row];
  }
  [[nodiscard]] std::string name(std::size_t family) const {
    return fmt::format("family {} ({})", family, _families.texts("name")[family]);
  }
  [[nodiscard]] std::string crossing_name(std::size_t crossing) const {
    return fmt::format("crossing {} ({} at T = {:.9g})", crossing, _crossings.texts("kind")[crossing],
                       _crossings.reals("period")[crossing]);
  }
  [[nodiscard]] Rows rows_of(std::size_t family) const {
    const auto begin = static_cast<std::size_t>(at(_families, "first_orbit", family));
    return {begin, begin + static_cast<std::size_t>(at(_families, "orbit_count", family))};
  }

  void check_names() {
    std::set<std::string> seen;
    for (const std::string& name : _families.texts("name")) {
      expect(!name.empty(), "a family has no name");
      expect(seen.insert(name).second, "two families have the name {}", name);
    }
  }

  void check_ends(std::size_t allowed) {
    std::vector<std::string> failed;
    for (std::size_t family = 0; family < _families.rows(); ++family) {
      const std::string& reason = _families.texts("end_reason")[family];
      const std::vector<survey::EndKind> ends = survey::ends_in(reason);
      if (std::find(ends.begin(), ends.end(), survey::EndKind::failure) != ends.end())
        failed.push_back(fmt::format("{}: {}", name(family), reason));
    }
    if (failed.size() > allowed) _problems.insert(_problems.end(), failed.begin(), failed.end());
  }

  void check_base_families(int expected) {
    const auto& parents = _families.integers("parent");
    const auto found = std::count_if(parents.begin(), parents.end(), [](std::int64_t row) { return row < 0; });
    expect(expected < 0 || found == expected, "{} families have no parent, where {} were expected", found, expected);
  }

  void check_ancestors(std::size_t family) {
    std::int64_t row = static_cast<std::int64_t>(family);
    for (std::size_t generation = 0; row >= 0; ++generation) {
      if (generation == _families.rows()) {
        expect(false, "{} is its own ancestor", name(family));
        return;
      }
      row = at(_families, "parent", static_cast<std::size_t>(row));
    }
  }

  void check_birth(std::size_t family) {
    const std::int64_t parent = at(_families, "parent", family);
    const std::int64_t row = at(_families, "crossing", family);
    expect((parent < 0) == (row < 0), "{} has parent {} and crossing {}: one of them is missing", name(family), parent,
           row);
    if (parent < 0 || row < 0) return;
    const auto crossing = static_cast<std::size_t>(row);
    const std::int64_t owner = at(_crossings, "family", crossing);
    expect(owner == parent, "{} was born at {}, which belongs to family {} and not to its parent {}", name(family),
           crossing_name(crossing), owner, parent);
    const std::int64_t m = at(_families, "multiplicity", family);
    expect(m == at(_crossings, "multiplicity", crossing), "{} has multiplicity {}, and {} has {}", name(family), m,
           crossing_name(crossing), at(_crossings, "multiplicity", crossing));
    check_first_orbit(family, crossing, static_cast<double>(m));
  }

  void check_first_orbit(std::size_t family, std::size_t crossing, double multiplicity) {
    const Rows rows = rows_of(family);
    if (rows.begin == rows.end) return;
    const auto& steps = _orbits.integers("step");
    const auto nearest = static_cast<std::size_t>(
        std::min_element(steps.begin() + static_cast<long>(rows.begin), steps.begin() + static_cast<long>(rows.end),
                         [](std::int64_t a, std::int64_t b) { return std::abs(a) < std::abs(b); }) -
        steps.begin());
    const double period = _orbits.reals("period")[nearest];
    const double expected = multiplicity * _crossings.reals("period")[crossing];
    expect(std::abs(period - expected) <= period_tolerance * expected,
           "{} begins with T = {:.9g}, where {} times around {} is {:.9g}", name(family), period, multiplicity,
           crossing_name(crossing), expected);
    const double gap = std::abs(_orbits.reals("energy")[nearest] - _crossings.reals("energy")[crossing]);
    expect(!(gap > energy_tolerance * energy_range()), "{} begins {:.3g} in energy away from {}", name(family), gap,
           crossing_name(crossing));
  }

  [[nodiscard]] double energy_range() const {
    double low = archive::not_computed;
    double high = archive::not_computed;
    for (const double energy : _orbits.reals("energy")) {
      low = std::fmin(low, energy);
      high = std::fmax(high, energy);
    }
    return high - low;
  }

  void check_death(std::size_t family) {
    const std::int64_t joined = at(_families, "end_family", family);
    const std::int64_t row = at(_families, "end_crossing", family);
    if (row < 0) return;
    const auto crossing = static_cast<std::size_t>(row);
    const std::int64_t owner = at(_crossings, "family", crossing);
    expect(owner == joined, "{} ends at {}, which belongs to family {} and not to family {}, which it joined",
           name(family), crossing_name(crossing), owner, joined);
  }

  void check_steps(std::size_t family) {
    const Rows rows = rows_of(family);
    const auto& steps = _orbits.integers("step");
    for (std::size_t row = rows.begin + 1; row < rows.end; ++row)
      expect(steps[row] == steps[row - 1] + 1, "{} goes from step {} to step {}", name(family), steps[row - 1],
             steps[row]);
  }

  // The orbits around a crossing: the first that lies beyond it along the family, or the last.
  [[nodiscard]] Rows neighbours(std::size_t crossing) const {
    const Rows rows = rows_of(static_cast<std::size_t>(at(_crossings, "family", crossing)));
    const auto& arclengths = _orbits.reals("arclength");
    std::size_t after = std::min(rows.begin + 1, rows.end);
    while (after < rows.end && arclengths[after] < _crossings.reals("arclength")[crossing]) ++after;
    return {after - 1, std::min(after, rows.end - 1)};
  }

  void check_place(std::size_t crossing) {
    const auto family = static_cast<std::size_t>(at(_crossings, "family", crossing));
    const Rows rows = rows_of(family);
    if (rows.end - rows.begin < 2) {
      expect(rows.begin < rows.end, "{} lies on {}, which has no orbits", crossing_name(crossing), name(family));
      return;
    }
    // Half a step beyond its ends, for what was located beside the first or the last orbit.
    const auto& arclengths = _orbits.reals("arclength");
    const double where = _crossings.reals("arclength")[crossing];
    const double least = arclengths[rows.begin] - 0.5 * (arclengths[rows.begin + 1] - arclengths[rows.begin]);
    if (where < arclengths[rows.begin] && at(_families, "crossing", family) >= 0)
      return check_before_first(crossing, rows);
    const double most = arclengths[rows.end - 1] + 0.5 * (arclengths[rows.end - 1] - arclengths[rows.end - 2]);
    expect(where >= least && where <= most, "{} lies at arclength {:.9g}, outside {} ({:.9g} .. {:.9g})",
           crossing_name(crossing), where, name(family), arclengths[rows.begin], arclengths[rows.end - 1]);
  }

  // Between a family's birth and its first orbit: so its period must lie, give or take half of that way.
  void check_before_first(std::size_t crossing, const Rows& rows) {
    const auto family = static_cast<std::size_t>(at(_crossings, "family", crossing));
    const auto birth = static_cast<std::size_t>(at(_families, "crossing", family));
    const double born = static_cast<double>(at(_families, "multiplicity", family)) * _crossings.reals("period")[birth];
    const double first = _orbits.reals("period")[rows.begin];
    const double period = _crossings.reals("period")[crossing];
    const double margin = 0.5 * std::abs(first - born);
    expect(period >= std::min(born, first) - margin && period <= std::max(born, first) + margin,
           "{} lies before the first orbit of {}, but not between its birth (T = {:.9g}) and that (T = {:.9g})",
           crossing_name(crossing), name(family), born, first);
  }

  // Index of the fundamental map that is nearest to `value`.
  [[nodiscard]] double index_at(std::size_t orbit, double value) const {
    const auto pairs = static_cast<std::size_t>(_atlas.header().pairs);
    const std::size_t parts = archive::has_complex_stability(_atlas.header()) ? 2 : 1;
    double nearest = archive::not_computed;
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      const double k = _orbits.reals("fundamental_stability")[(orbit * pairs + pair) * parts];
      if (std::isnan(nearest) || std::abs(k - value) < std::abs(nearest - value)) nearest = k;
    }
    return nearest;
  }

  [[nodiscard]] double location_bound(std::size_t crossing, double value) const {
    const Rows around = neighbours(crossing);
    const auto& errors = _orbits.reals("stability_error");
    const auto& arclengths = _orbits.reals("arclength");
    const double length = arclengths[around.end] - arclengths[around.begin];
    const double slope = (index_at(around.end, value) - index_at(around.begin, value)) / length;
    return std::fmax(1e-9, std::fmax(std::fmax(errors[around.begin], errors[around.end]), std::abs(slope) * 1e-10));
  }

  void check_location(std::size_t crossing) {
    if (!archive::has_sector(_atlas.crossing_kinds()[crossing])) return;
    const double j = static_cast<double>(at(_crossings, "sector_j", crossing));
    const double q = static_cast<double>(at(_crossings, "sector_q", crossing));
    const auto family = static_cast<std::size_t>(at(_crossings, "family", crossing));
    if (at(_families, "orbit_count", family) == 0) return;  // check_place
    const double value = 2.0 * std::cos(2.0 * std::numbers::pi * j / q);
    const double gap = std::abs(_crossings.reals("test_value")[crossing] - value);
    const double bound = location_bound(crossing, value);
    expect(gap <= bound, "{} was located with an index {:.3g} from 2 cos(2 pi {}/{}), where {:.3g} is allowed",
           crossing_name(crossing), gap, j, q, bound);
    const double residual = std::abs(_crossings.reals("residual")[crossing]);
    expect(residual <= bound, "{} has a residual of {:.3g}, where {:.3g} is allowed", crossing_name(crossing), residual,
           bound);
  }

  const Archive& _atlas;
  const Table& _families;
  const Table& _orbits;
  const Table& _crossings;
  std::vector<std::string>& _problems;
};

}  // namespace

std::vector<std::string> tree_problems(const Archive& atlas, const TreeOptions& options) {
  std::vector<std::string> problems;
  Tree(atlas, problems).check(options);
  return problems;
}

}  // namespace orbweaver::test
