#include "show_values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

std::string csv_number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.17g}", value); }
std::string short_number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.10g}", value); }

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

// Name of value `index` within a row of a vector column: state_th1, winding_n1, stability_0, stability_0_re.
std::string value_name(const archive::Header& header, const archive::ColumnSpec& spec, std::size_t index) {
  if (spec.row_shape.empty()) return spec.name;
  if (spec.name == "state") return "state_" + header.state_names[index];
  if (spec.name == "winding") return "winding_" + header.winding_names[index];
  if (spec.row_shape.size() == 2) return fmt::format("{}_{}_{}", spec.name, index / 2, index % 2 == 0 ? "re" : "im");
  return fmt::format("{}_{}", spec.name, index);
}

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

// Those that are shown: all but the checksums, which an archive has been held against when it was opened.
std::vector<const archive::Column*> shown_columns(const archive::Table& table) {
  std::vector<const archive::Column*> columns;
  for (const archive::Column& column : table.columns())
    if (!archive::is_checksum(column.spec)) columns.push_back(&column);
  return columns;
}

}  // namespace

void print_csv(std::ostream& out, const archive::Header& header, const archive::Table& table) {
  std::vector<std::string> heads;
  const std::vector<const archive::Column*> columns = shown_columns(table);
  for (const archive::Column* column : columns)
    for (std::size_t i = 0; i < column->spec.width(); ++i)
      heads.push_back(csv_text(value_name(header, column->spec, i)));
  out << fmt::format("{}\n", fmt::join(heads, ","));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::vector<std::string> cells;
    for (const archive::Column* column : columns) {
      const std::size_t width = column->spec.width();
      for (std::size_t i = 0; i < width; ++i)
        cells.push_back(value_text(*column, row * width + i, csv_number, csv_text));
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

std::string json_value(const archive::Column& column, std::size_t row) {
  const std::size_t width = column.spec.width();
  if (column.spec.row_shape.empty()) return value_text(column, row, json_number, json_text);
  if (column.spec.row_shape.size() == 2) return json_pairs(column, row, width);
  std::vector<std::string> values;
  for (std::size_t i = row * width; i < (row + 1) * width; ++i)
    values.push_back(value_text(column, i, json_number, json_text));
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

void print_json(std::ostream& out, const archive::Table& table) {
  out << '[';
  const std::vector<const archive::Column*> columns = shown_columns(table);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::vector<std::string> members;
    for (const archive::Column* column : columns)
      members.push_back(fmt::format("\"{}\": {}", column->spec.name, json_value(*column, row)));
    out << fmt::format("{}\n  {{{}}}", row == 0 ? "" : ",", fmt::join(members, ", "));
  }
  out << (table.rows() == 0 ? "]\n" : "\n]\n");
}

void print_readable(std::ostream& out, const archive::Header& header, const archive::Table& table) {
  TextGrid grid;
  for (const archive::Column* column : shown_columns(table)) {
    const std::size_t width = column->spec.width();
    for (std::size_t i = 0; i < width; ++i) {
      std::vector<std::string> cells;
      for (std::size_t row = 0; row < table.rows(); ++row)
        cells.push_back(value_text(*column, row * width + i, short_number, plain));
      grid.add_column(value_name(header, column->spec, i), std::move(cells),
                      column->spec.type != archive::ColumnType::text);
    }
  }
  grid.print(out);
}

}  // namespace orbweaver::report
