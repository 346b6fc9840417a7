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

template <class Value>
std::vector<Value> of_rows(const std::vector<Value>& values, const std::vector<std::size_t>& rows) {
  std::vector<Value> chosen;
  for (const std::size_t row : rows) chosen.push_back(values[row]);
  return chosen;
}

}  // namespace

void print_equilibria(std::ostream& out, const archive::Archive& atlas, const std::vector<std::size_t>& rows) {
  const archive::Table& table = atlas.equilibria();
  const std::vector<std::string>& names = atlas.header().state_names;
  const Level level = level_of(atlas);
  TextGrid grid;
  std::vector<std::string> numbers;
  std::vector<std::string> steps;
  std::vector<std::string> periods;
  for (const std::size_t row : rows) {
    numbers.push_back(std::to_string(table.integers("equilibrium")[row] + 1));
    steps.push_back(std::to_string(table.integers("step")[row]));
    periods.push_back(periods_text(table, row));
  }
  grid.add_column("equilibrium", numbers);
  grid.add_column("step", steps);
  grid.add_column("kind", of_rows(table.texts("kind"), rows), false);
  grid.add_column(level.title, cells_of(of_rows(table.reals(level.column), rows), "{:.10g}"));
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<double> values;
    for (const std::size_t row : rows) values.push_back(table.reals("state")[row * names.size() + i]);
    grid.add_column(names[i], cells_of(values, "{:.10g}"));
  }
  grid.add_column("stability", of_rows(table.texts("stability"), rows), false);
  grid.add_column("periods", periods, false);
  grid.add_column("note", of_rows(table.texts("note"), rows), false);
  grid.print(out);
}

void print_left_out_equilibria(std::ostream& out, const archive::Archive& atlas, std::size_t shown) {
  const std::size_t points = atlas.equilibria().rows();
  if (shown == points) return;
  out << fmt::format(
      "{} of {} points are left out, at which nothing is but that a curve goes on; with --all they are shown\n",
      points - shown, points);
}

}  // namespace orbweaver::report
