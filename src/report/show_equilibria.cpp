#include "show_equilibria.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "show_level.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

/// "5.2, 2.9 (2)": the periods of a row, with how many oscillations share one.
std::string periods_text(const archive::Table& table, std::size_t row) {
  const std::size_t width = table.column("periods").spec.width();
  std::vector<std::string> cells;
  for (std::size_t n = row * width; n < (row + 1) * width; ++n) {
    if (std::isnan(table.reals("periods")[n])) continue;
    cells.push_back(fmt::format("{:.10g}", table.reals("periods")[n]));
    if (const auto count = table.integers("multiplicity")[n]; count > 1) cells.back() += fmt::format(" ({})", count);
  }
  return cells.empty() ? "-" : fmt::format("{}", fmt::join(cells, ", "));
}

}  // namespace

void print_equilibria(std::ostream& out, const archive::Archive& atlas) {
  const archive::Table& table = atlas.equilibria();
  const std::vector<std::string>& names = atlas.header().state_names;
  const Level level = level_of(atlas);
  TextGrid grid;
  std::vector<std::string> numbers;
  std::vector<std::string> steps;
  std::vector<std::string> periods;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    numbers.push_back(std::to_string(table.integers("equilibrium")[row] + 1));
    steps.push_back(std::to_string(table.integers("step")[row]));
    periods.push_back(periods_text(table, row));
  }
  grid.add_column("equilibrium", numbers);
  grid.add_column("step", steps);
  grid.add_column("kind", table.texts("kind"), false);
  grid.add_column(level.title, cells_of(table.reals(level.column), "{:.10g}"));
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.reals("state")[row * names.size() + i]);
    grid.add_column(names[i], cells_of(values, "{:.10g}"));
  }
  grid.add_column("stability", table.texts("stability"), false);
  grid.add_column("periods", periods, false);
  grid.add_column("note", table.texts("note"), false);
  grid.print(out);
}

}  // namespace orbweaver::report
