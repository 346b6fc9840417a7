#include "orbweaver/archive/read/table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace orbweaver::archive {

namespace {

Column::Values empty_values(const ColumnSpec& spec, std::size_t rows) {
  const std::size_t count = rows * spec.width();
  switch (spec.type) {
    case ColumnType::integer: return std::vector<std::int64_t>(count, -1);
    case ColumnType::text: return std::vector<std::string>(count);
    case ColumnType::real: break;
  }
  return std::vector<double>(count, not_computed);
}

template <class Value, class Self>
auto& values_of(Self& table, std::string_view name) {
  auto* values = std::get_if<std::vector<Value>>(&table.column(name).values);
  if (values == nullptr)
    throw core::MisuseError(fmt::format("column '{}' of table '{}' is of another type", name, table.name()));
  return *values;
}

template <class Columns>
auto& find_column(Columns& columns, const std::string& table, std::string_view name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.spec.name == name; });
  if (found == columns.end()) throw core::MisuseError(fmt::format("table '{}' has no column '{}'", table, name));
  return *found;
}

}  // namespace

Column::Column(ColumnSpec column_spec, std::size_t rows)
    : spec(std::move(column_spec)), values(empty_values(spec, rows)) {}

Table::Table(const TableSpec& spec, std::size_t rows) : _name(spec.name), _rows(rows) {
  for (const ColumnSpec& column : spec.columns) _columns.emplace_back(column, rows);
}

const Column& Table::column(std::string_view name) const { return find_column(_columns, _name, name); }
Column& Table::column(std::string_view name) { return find_column(_columns, _name, name); }

const std::vector<std::int64_t>& Table::integers(std::string_view name) const {
  return values_of<std::int64_t>(*this, name);
}
const std::vector<double>& Table::reals(std::string_view name) const { return values_of<double>(*this, name); }
const std::vector<std::string>& Table::texts(std::string_view name) const {
  return values_of<std::string>(*this, name);
}
std::vector<std::int64_t>& Table::integers(std::string_view name) { return values_of<std::int64_t>(*this, name); }
std::vector<double>& Table::reals(std::string_view name) { return values_of<double>(*this, name); }
std::vector<std::string>& Table::texts(std::string_view name) { return values_of<std::string>(*this, name); }

TableSpec Table::spec() const {
  TableSpec spec{_name, {}};
  for (const Column& column : _columns) spec.columns.push_back(column.spec);
  return spec;
}

}  // namespace orbweaver::archive
