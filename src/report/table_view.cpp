#include "table_view.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "family_row.hpp"

namespace orbweaver::report {

namespace {

using archive::Column;
using Shown = TableView::Shown;

std::vector<Shown> all_columns(const archive::Table& table) {
  std::vector<Shown> columns;
  for (const Column& column : table.columns())
    if (!archive::is_checksum(column.spec)) columns.push_back({&column, column.spec.name, 0, column.spec.width()});
  return columns;
}

/// The parameter that moves names its column too, as the heads of tables do.
Shown named_column(const archive::Archive& atlas, const archive::Table& table, const std::string& name) {
  const archive::Header& header = atlas.header();
  const std::vector<Shown> all = all_columns(table);
  const std::string moving = atlas.moving_parameter();
  const std::string column = !moving.empty() && name == moving ? "parameter" : name;
  std::vector<std::string> names;
  for (const Shown& shown : all) {
    if (shown.name == column) return shown;
    names.push_back(shown.name);
    for (std::size_t i = 0; i < shown.count; ++i)
      if (value_name(header, shown.column->spec, i) == name) return {shown.column, name, i, 1};
  }
  throw core::InputError(fmt::format("no column `{}`: {} has {}, and values of columns such as state_{}", name,
                                     table.name(), fmt::join(names, ", "), header.state_names.front()));
}

std::vector<std::size_t> rows_of_family(const archive::Archive& atlas, const archive::Table& table,
                                        const std::string& family) {
  const std::size_t row = family_row(atlas, family);
  if (&table == &atlas.families()) return {row};
  const auto has = [](const Column& column) { return column.spec.name == "family"; };
  if (std::none_of(table.columns().begin(), table.columns().end(), has))
    throw core::InputError(fmt::format("the rows of {} belong to no family", table.name()));
  const std::vector<std::int64_t>& of_rows = table.integers("family");
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < of_rows.size(); ++n)
    if (of_rows[n] == static_cast<std::int64_t>(row)) rows.push_back(n);
  return rows;
}

/// Rows with equal values stay in their order; those without a value come last, both ways.
void sort_rows(std::vector<std::size_t>& rows, const Shown& by, bool descending) {
  const std::size_t width = by.column->spec.width();
  std::visit(
      [&](const auto& values) {
        std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
          const auto& x = values[a * width + by.first];
          const auto& y = values[b * width + by.first];
          if constexpr (std::is_same_v<std::decay_t<decltype(x)>, double>)
            if (std::isnan(x) || std::isnan(y)) return !std::isnan(x) && std::isnan(y);
          return descending ? y < x : x < y;
        });
      },
      by.column->values);
}

}  // namespace

std::string value_name(const archive::Header& header, const archive::ColumnSpec& spec, std::size_t index) {
  if (spec.row_shape.empty()) return spec.name;
  if (spec.name == "state") return "state_" + header.state_names[index];
  if (spec.name == "winding") return "winding_" + header.winding_names[index];
  if (spec.row_shape.size() == 2) return fmt::format("{}_{}_{}", spec.name, index / 2, index % 2 == 0 ? "re" : "im");
  return fmt::format("{}_{}", spec.name, index);
}

TableView view_of(const archive::Archive& atlas, const archive::Table& table, const Selection& selection) {
  TableView view;
  for (const std::string& name : selection.columns) view.columns.push_back(named_column(atlas, table, name));
  if (selection.columns.empty()) view.columns = all_columns(table);
  view.rows.resize(table.rows());
  std::iota(view.rows.begin(), view.rows.end(), 0);
  if (!selection.family.empty()) view.rows = rows_of_family(atlas, table, selection.family);
  if (!selection.sort.empty()) {
    const bool descending = selection.sort.front() == '-';
    const Shown by = named_column(atlas, table, selection.sort.substr(descending ? 1 : 0));
    if (by.count != 1)
      throw core::InputError(fmt::format("cannot sort by `{}`, which has {} values: name one, such as {}", by.name,
                                         by.count, value_name(atlas.header(), by.column->spec, 0)));
    sort_rows(view.rows, by, descending);
  }
  return view;
}

}  // namespace orbweaver::report
