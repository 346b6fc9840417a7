#include "orbweaver/report/cost/cost_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "csv_text.hpp"
#include "gnuplot.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

using cost::Cell;
using cost::Column;
using cost::Table;

constexpr std::size_t longest_words = 44;  // of a cell: with the other columns a line stays below line_width

std::string cell_text(const Cell& cell) {
  if (!cell.words.empty()) return cut(cell.words, longest_words);
  if (std::isnan(cell.number)) return "-";
  const double size = std::abs(cell.number);
  if (cell.number == std::round(cell.number) && size < 1e6) return fmt::format("{:.0f}", cell.number);
  return size >= 0.01 && size < 1e5 ? fmt::format("{:.4g}", cell.number) : fmt::format("{:.2e}", cell.number);
}

std::string head_text(const Column& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

bool has_words(const Table& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const std::vector<Cell>& row) { return !row[column].words.empty(); });
}

std::string csv_head(const Column& column) {
  std::string head = column.unit.empty() ? column.name : column.name + "_" + column.unit;
  std::replace(head.begin(), head.end(), ' ', '_');
  return head;
}

std::string csv_cell(const Cell& cell) {
  if (cell.words.empty()) return std::isnan(cell.number) ? std::string() : fmt::format("{}", cell.number);
  return csv_text(cell.words);
}

std::string terminal_of(PlotFormat format) {
  switch (format) {
    case PlotFormat::svg: return "svg size 820,520 dynamic font 'sans,13' background 'white'";
    case PlotFormat::pdf: return "pdfcairo size 16cm,10cm font 'sans,11'";
    case PlotFormat::png: return "pngcairo size 1230,780 font 'sans,14'";
  }
  return "";
}

std::string key_of(const Table& table, const std::vector<Cell>& row, const std::vector<std::size_t>& columns) {
  std::vector<std::string> parts;
  for (const std::size_t column : columns)
    parts.push_back(table.columns[column].name == "time map"
                        ? (row[column].words == "yes" ? "time map" : "even in time")
                        : cell_text(row[column]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

struct Series {
  std::string key;
  std::vector<std::pair<double, double>> points;
};

std::vector<Series> series_of(const Table& table, const std::string& panel) {
  std::vector<Series> all;
  const cost::Plot& plot = *table.plot;
  for (const std::vector<Cell>& row : table.rows) {
    if (plot.panel && row[*plot.panel].words != panel) continue;
    const double x = row[plot.x].number;
    const double y = row[plot.y].number;
    if (!(x > 0.0) || !(y > 0.0) || !std::isfinite(x) || !std::isfinite(y)) continue;  // no place on such axes
    const std::string key = key_of(table, row, plot.series);
    auto found = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.key == key; });
    if (found == all.end()) found = all.insert(all.end(), {key, {}});
    found->points.emplace_back(x, y);
  }
  return all;
}

/// Nothing to see: an axis without a length.
bool has_one_place(const std::vector<Series>& all) {
  const double x = all.front().points.front().first;
  return std::all_of(all.begin(), all.end(), [&](const Series& s) {
    return std::all_of(s.points.begin(), s.points.end(), [&](const auto& point) { return point.first == x; });
  });
}

/// gnuplot's filled and open shapes, then its crosses: no two lines of a plot have one.
std::size_t point_of(std::size_t n) {
  constexpr std::size_t first_shape = 4;
  constexpr std::size_t shapes = 10;
  return n < shapes ? first_shape + n : 1 + (n - shapes) % 3;
}

/// One notation along an axis: plain numbers where they are short, else powers of ten.
template <class Of>
const char* tics_of(const std::vector<Series>& all, const Of& of) {
  constexpr double short_from = 0.1;
  constexpr double short_to = 1e5;
  for (const Series& series : all)
    for (const auto& point : series.points)
      if (of(point) < short_from || of(point) > short_to) return "%.0e";
  return "%g";
}

std::string script_of(const Table& table, const std::string& name, const std::string& panel, PlotFormat format) {
  const cost::Plot& plot = *table.plot;
  const std::vector<Series> all = series_of(table, panel);
  if (all.empty() || has_one_place(all)) return {};
  std::string script;
  for (std::size_t n = 0; n < all.size(); ++n) {
    script += fmt::format("$data{} << END\n", n);
    for (const auto& [x, y] : all[n].points) script += fmt::format("{} {}\n", x, y);
    script += "END\n";
  }
  const std::string title =
      panel.empty() ? table.title : fmt::format("{} ({} {})", table.title, table.columns[*plot.panel].name, panel);
  script += fmt::format(
      "set terminal {} noenhanced\nset output {}\nset title {}\nset xlabel {}\nset ylabel {}\n"
      "set logscale xy\nset grid xtics ytics linetype 1 linecolor '#dddddd' linewidth 0.6\nset border 3\nset tics "
      "nomirror\n"
      "set key below horizontal height 1\nset xlabel offset 0,0.4\nset format x '{}'\nset format y '{}'\n",
      terminal_of(format), gnuplot_text(fmt::format("{}.{}", name, ending_of(format))), gnuplot_text(title),
      gnuplot_text(head_text(table.columns[plot.x])), gnuplot_text(head_text(table.columns[plot.y])),
      tics_of(all, [](const auto& point) { return point.first; }),
      tics_of(all, [](const auto& point) { return point.second; }));
  for (std::size_t n = 0; n < all.size(); ++n)
    script += fmt::format(
        "{}$data{} using 1:2 with linespoints title {} linecolor '{}' linewidth 1.6 dashtype {} pointtype {} pointsize "
        "0.7",
        n == 0 ? "plot " : ", \\\n     ", n, gnuplot_text(all[n].key), plot_colours[n % plot_colours.size()],
        n / plot_colours.size() + 1, point_of(n));
  return script + "\n";
}

}  // namespace

std::string table_text(const Table& table) {
  std::string text = table.title + "\n";
  if (!table.rows.empty()) {
    TextGrid grid;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      std::vector<std::string> cells;
      for (const std::vector<Cell>& row : table.rows) cells.push_back(cell_text(row[c]));
      const bool empty = std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<Cell>& row) {
        return row[c].words.empty() && std::isnan(row[c].number);
      });
      if (!empty) grid.add_column(head_text(table.columns[c]), std::move(cells), !has_words(table, c));
    }
    for (const std::string& line : grid.lines()) text += "  " + line + "\n";
  }
  for (const std::string& remark : table.remarks)
    for (const std::string& line : wrap(remark, line_width, 2)) text += line + "\n";
  return text + "\n";
}

std::string table_csv(const Table& table) {
  std::vector<std::string> heads;
  for (const Column& column : table.columns) heads.push_back(csv_head(column));
  std::string csv = fmt::format("{}\n", fmt::join(heads, ","));
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string> cells;
    for (const Cell& cell : row) cells.push_back(csv_cell(cell));
    csv += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return csv;
}

std::vector<Picture> pictures_of(const Table& table, PlotFormat format) {
  std::vector<Picture> pictures;
  if (!table.plot) return pictures;
  std::vector<std::string> panels;
  if (!table.plot->panel)
    panels.emplace_back();
  else
    for (const std::vector<Cell>& row : table.rows)
      if (const std::string& panel = row[*table.plot->panel].words;
          std::find(panels.begin(), panels.end(), panel) == panels.end())
        panels.push_back(panel);
  for (const std::string& panel : panels) {
    const std::string name = panel.empty() ? table.name : fmt::format("{}_{}", table.name, panel);
    if (std::string script = script_of(table, name, panel, format); !script.empty())
      pictures.push_back({name, std::move(script)});
  }
  return pictures;
}

bool draw(const std::filesystem::path& folder, const Picture& picture) {
  return run_gnuplot(folder, picture.name, picture.script);
}

}  // namespace orbweaver::report
