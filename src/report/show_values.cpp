#include "show_values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "csv_text.hpp"
#include "json_text.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

std::string short_number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.10g}", value); }

// Writes the values of a row of a column through the three printers.
template <class Number>
std::string value_text(const archive::Column& column, std::size_t at, const Number& number,
                       std::string (*text)(const std::string&)) {
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&column.values))
    return std::to_string((*integers)[at]);
  if (const auto* reals = std::get_if<std::vector<double>>(&column.values)) return number((*reals)[at]);
  return text(std::get<std::vector<std::string>>(column.values)[at]);
}

std::string plain(const std::string& text) { return text; }

std::string family_name(const archive::Archive& atlas, const archive::Column& families, std::size_t row) {
  const std::int64_t family = std::get<std::vector<std::int64_t>>(families.values)[row];
  return family < 0 ? "-" : atlas.families().texts("name")[static_cast<std::size_t>(family)];
}

}  // namespace

void print_csv(std::ostream& out, const archive::Header& header, const TableView& view) {
  std::vector<std::string> heads;
  for (const TableView::Shown& shown : view.columns)
    for (std::size_t i = shown.first; i < shown.first + shown.count; ++i)
      heads.push_back(csv_text(value_name(header, shown.column->spec, i)));
  out << fmt::format("{}\n", fmt::join(heads, ","));
  for (const std::size_t row : view.rows) {
    std::vector<std::string> cells;
    for (const TableView::Shown& shown : view.columns) {
      const std::size_t first = row * shown.column->spec.width() + shown.first;
      for (std::size_t i = first; i < first + shown.count; ++i)
        cells.push_back(value_text(*shown.column, i, csv_number, csv_text));
    }
    out << fmt::format("{}\n", fmt::join(cells, ","));
  }
}

namespace {

std::string json_pairs(const archive::Column& column, std::size_t row, std::size_t width) {
  std::vector<std::string> pairs;
  for (std::size_t i = row * width; i < (row + 1) * width; i += 2)
    pairs.push_back(fmt::format("[{}, {}]", value_text(column, i, json_number, json_text),
                                value_text(column, i + 1, json_number, json_text)));
  return fmt::format("[{}]", fmt::join(pairs, ", "));
}

std::string json_value(const TableView::Shown& shown, std::size_t row) {
  const archive::Column& column = *shown.column;
  const std::size_t width = column.spec.width();
  if (column.spec.row_shape.empty() || !shown.is_whole())
    return value_text(column, row * width + shown.first, json_number, json_text);
  if (column.spec.row_shape.size() == 2) return json_pairs(column, row, width);
  std::vector<std::string> values;
  for (std::size_t i = row * width; i < (row + 1) * width; ++i)
    values.push_back(value_text(column, i, json_number, json_text));
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

void print_json(std::ostream& out, const TableView& view) {
  out << '[';
  for (std::size_t n = 0; n < view.rows.size(); ++n) {
    std::vector<std::string> members;
    for (const TableView::Shown& shown : view.columns)
      members.push_back(fmt::format("\"{}\": {}", shown.name, json_value(shown, view.rows[n])));
    out << fmt::format("{}\n  {{{}}}", n == 0 ? "" : ",", fmt::join(members, ", "));
  }
  out << (view.rows.empty() ? "]\n" : "\n]\n");
}

void drop_unread_columns(TableView& view) {
  std::erase_if(view.columns, [&](const TableView::Shown& shown) {
    const std::string& name = shown.column->spec.name;
    if (name.ends_with("_begin") || name.ends_with("_count")) return true;
    const auto* reals = std::get_if<std::vector<double>>(&shown.column->values);
    return reals != nullptr && std::all_of(reals->begin(), reals->end(), [](double x) { return std::isnan(x); });
  });
}

void print_readable(std::ostream& out, const archive::Archive& atlas, const TableView& view) {
  TextGrid grid;
  for (const TableView::Shown& shown : view.columns) {
    const archive::ColumnSpec& spec = shown.column->spec;
    const bool names_a_family = spec.name == "family";
    for (std::size_t i = shown.first; i < shown.first + shown.count; ++i) {
      std::vector<std::string> cells;
      for (const std::size_t row : view.rows)
        cells.push_back(names_a_family ? family_name(atlas, *shown.column, row)
                                       : value_text(*shown.column, row * spec.width() + i, short_number, plain));
      grid.add_column(value_name(atlas.header(), spec, i), std::move(cells),
                      !names_a_family && spec.type != archive::ColumnType::text);
    }
  }
  grid.print(out);
}

}  // namespace orbweaver::report
