#include "show_crossings.hpp"

#include <cstdint>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "show_level.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

std::vector<std::string> families_of(const archive::Archive& atlas) {
  std::vector<std::string> cells;
  for (const std::int64_t family : atlas.crossings().integers("family"))
    cells.push_back(atlas.families().texts("name")[static_cast<std::size_t>(family)]);
  return cells;
}

// Names of the families whose `column` is each crossing: those born there, those that end there.
std::vector<std::string> families_at(const archive::Archive& atlas, const std::string& column) {
  std::vector<std::vector<std::string>> names(atlas.crossings().rows());
  const auto& crossings = atlas.families().integers(column);
  for (std::size_t row = 0; row < crossings.size(); ++row)
    if (crossings[row] >= 0)
      names[static_cast<std::size_t>(crossings[row])].push_back(atlas.families().texts("name")[row]);
  std::vector<std::string> cells;
  for (const auto& list : names) cells.push_back(list.empty() ? "-" : fmt::format("{}", fmt::join(list, ", ")));
  return cells;
}

}  // namespace

std::string crossing_text(const archive::Archive& atlas, std::size_t crossing) {
  const archive::Table& crossings = atlas.crossings();
  const std::string parameter = atlas.moving_parameter();
  return fmt::format(
      "{} T {:.6g}{}", crossings.texts("kind")[crossing], crossings.reals("period")[crossing],
      parameter.empty() ? "" : fmt::format(", {} {:.6g}", parameter, crossings.reals("parameter")[crossing]));
}

void print_crossings(std::ostream& out, const archive::Archive& atlas, const std::vector<std::size_t>& rows) {
  const archive::Table& crossings = atlas.crossings();
  std::vector<std::int64_t> numbers(crossings.rows());
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  TextGrid grid;
  grid.add_column("row", cells_of(numbers));
  grid.add_column("family", families_of(atlas), false);
  grid.add_column("period", cells_of(crossings.reals("period"), "{:.10g}"));
  const Level level = level_of(atlas);
  grid.add_column(level.title, cells_of(crossings.reals(level.column), "{:.10g}"));
  grid.add_column("kind", crossings.texts("kind"), false);
  grid.add_column("m", cells_of(crossings.integers("multiplicity")));
  grid.add_column("q", cells_of(crossings.integers("sector_q")));
  grid.add_column("j", cells_of(crossings.integers("sector_j")));
  grid.add_column("kernel", cells_of(crossings.integers("kernel_dimension")));
  const std::string in_level = fmt::format("place_error_{}", level.column);
  grid.add_column("place error", cells_of(crossings.reals("place_error"), "{:.1e}"));
  grid.add_column(fmt::format("in {}", level.title), cells_of(crossings.reals(in_level), "{:.1e}"));
  grid.add_column("residual", cells_of(crossings.reals("residual"), "{:.1e}"));
  grid.add_column("test value", cells_of(crossings.reals("test_value"), "{:.8g}"));
  grid.add_column("born there", families_at(atlas, "crossing"), false);
  grid.add_column("end there", families_at(atlas, "end_crossing"), false);
  const std::vector<std::string> lines = grid.lines();
  out << lines.front() << '\n';
  for (const std::size_t row : rows) out << lines[row + 1] << '\n';
}

}  // namespace orbweaver::report
