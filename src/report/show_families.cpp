#include "show_families.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/styled.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "show_crossings.hpp"
#include "show_level.hpp"
#include "show_stability.hpp"
#include "show_verdicts.hpp"
#include "stability_line.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t longest_name = 36;
constexpr std::size_t stability_cells = 16;
constexpr std::size_t longest_reason = 250;
constexpr std::size_t deepest_indentation = 12;  // levels; a survey follows 16 at most, and a third of a name is left

std::size_t indentation(std::size_t depth) { return 2 * std::min(depth, deepest_indentation); }

struct Node {
  std::size_t family;
  std::size_t depth;
};

class Tree {
 public:
  explicit Tree(const std::vector<std::int64_t>& parents) : _children(parents.size()), _is_listed(parents.size()) {
    for (std::size_t row = 0; row < parents.size(); ++row)
      if (parents[row] >= 0) _children[static_cast<std::size_t>(parents[row])].push_back(row);
    for (std::size_t row = 0; row < parents.size(); ++row)
      if (parents[row] < 0) list_from(row);
    // Parents that go round in a circle: not a tree, but nothing is hidden.
    for (std::size_t row = 0; row < parents.size(); ++row) list_from(row);
  }

  [[nodiscard]] const std::vector<Node>& nodes() const { return _nodes; }

 private:
  void list_from(std::size_t root) {
    std::vector<Node> waiting{{root, 0}};
    while (!waiting.empty()) {
      const Node node = waiting.back();
      waiting.pop_back();
      if (_is_listed[node.family]) continue;
      _is_listed[node.family] = true;
      _nodes.push_back(node);
      const std::vector<std::size_t>& children = _children[node.family];
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        waiting.push_back({*child, node.depth + 1});
    }
  }

  std::vector<std::vector<std::size_t>> _children;
  std::vector<bool> _is_listed;
  std::vector<Node> _nodes;
};

std::string born_text(const archive::Archive& atlas, std::size_t family) {
  const std::int64_t crossing = atlas.families().integers("crossing")[family];
  if (crossing < 0) return "-";
  const auto row = static_cast<std::size_t>(crossing);
  return fmt::format("{}, m {}", crossing_text(atlas, row), atlas.crossings().integers("multiplicity")[row]);
}

std::string end_text(const archive::Archive& atlas, std::size_t family) {
  const std::string& reason = atlas.families().texts("end_reason")[family];
  const std::string text = "ended: " + cut(reason, longest_reason);
  const std::int64_t joined = atlas.families().integers("end_family")[family];
  const std::int64_t crossing = atlas.families().integers("end_crossing")[family];
  if (joined < 0) return text;
  const std::string& name = atlas.families().texts("name")[static_cast<std::size_t>(joined)];
  const std::vector<survey::EndKind> ends = survey::ends_in(reason);
  if (std::find(ends.begin(), ends.end(), survey::EndKind::joined) != ends.end()) return text;  // said already
  const std::string where = crossing < 0 ? "" : " at " + crossing_text(atlas, static_cast<std::size_t>(crossing));
  return fmt::format("{} -> {}{}", text, name, where);
}

std::string details(const archive::Archive& atlas, std::size_t family) {
  std::string text;
  for (const std::string& part :
       {atlas.families().texts("isotropy")[family], stability_text(atlas, family), doubts_text(atlas, family)})
    if (!part.empty()) text += part + "; ";
  return text + end_text(atlas, family);
}

core::Style style_of(const archive::Archive& atlas, std::size_t family) {
  const std::vector<survey::EndKind> ends = survey::ends_in(atlas.families().texts("end_reason")[family]);
  if (std::find(ends.begin(), ends.end(), survey::EndKind::failure) != ends.end()) return core::Style::bad;
  return doubts_text(atlas, family).empty() ? core::Style::faint : core::Style::warning;
}

std::string range_of(const archive::Archive& atlas, const char* column, std::size_t family) {
  return range_text(atlas.orbits().reals(column),
                    static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]),
                    static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]));
}

}  // namespace

std::string range_text(const std::vector<double>& values, std::size_t first, std::size_t count) {
  double low = archive::not_computed;
  double high = archive::not_computed;
  for (std::size_t i = first; i < first + count; ++i) {
    low = std::fmin(low, values[i]);
    high = std::fmax(high, values[i]);
  }
  return std::isnan(low) ? "-" : fmt::format("{:.6g} .. {:.6g}", low, high);
}

void print_families(std::ostream& out, const archive::Archive& atlas, const Layout& layout) {
  const Tree tree(atlas.families().integers("parent"));
  std::vector<std::string> names, born, orbits, periods, levels, stabilities;
  const OrbitStability stability(atlas);
  const Level level = level_of(atlas);
  for (const auto& [family, depth] : tree.nodes()) {
    names.push_back(cut(std::string(indentation(depth), ' ') + atlas.families().texts("name")[family], longest_name));
    born.push_back(born_text(atlas, family));
    orbits.push_back(std::to_string(atlas.families().integers("orbit_count")[family]));
    periods.push_back(range_of(atlas, "period", family));
    levels.push_back(range_of(atlas, level.column, family));
    stabilities.push_back(stability_line(atlas, stability, family, stability_cells, layout.unicode));
  }
  // What does not fit beside the numbers stands before the details.
  std::vector<std::string> before(tree.nodes().size());
  const auto prepend = [&before](const std::vector<std::string>& texts, const char* head, const char* tail) {
    for (std::size_t i = 0; i < before.size(); ++i)
      if (!texts[i].empty() && texts[i] != "-") before[i] = head + texts[i] + tail + before[i];
  };
  const auto grid_of = [&](bool with_birth) {
    TextGrid grid;
    grid.add_column("family", names, false);
    if (with_birth) grid.add_column("born at", born, false);
    grid.add_column("orbits", orbits);
    grid.add_column("period", periods);
    grid.add_column(level.title, levels);
    return grid;
  };
  TextGrid grid = grid_of(true);
  if (grid.width() > layout.width) {
    grid = grid_of(false);
    prepend(born, "", "; ");
  }
  const bool has_stability =
      std::any_of(stabilities.begin(), stabilities.end(), [](const std::string& line) { return !line.empty(); });
  if (has_stability && grid.width() + 2 + stability_cells <= layout.width)
    grid.add_column("stability", stabilities, false);
  else
    prepend(stabilities, "", " ");
  const std::vector<std::string> lines = grid.lines();
  out << core::Styled{core::Style::heading, lines.front()} << '\n';
  for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
    const auto& [family, depth] = tree.nodes()[i];
    out << lines[i + 1] << '\n';
    for (const std::string& line : wrap(before[i] + details(atlas, family), layout.width, indentation(depth) + 4))
      out << core::Styled{style_of(atlas, family), line} << '\n';
  }
}

}  // namespace orbweaver::report
