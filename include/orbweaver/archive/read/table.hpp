#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::archive {

/// One column in memory: rows x width values, row after row. Integers are -1 and reals NaN until they are set.
struct Column {
  using Values = std::variant<std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>>;

  Column() = default;
  Column(ColumnSpec column_spec, std::size_t rows);

  ColumnSpec spec;
  Values values;
};

/// A table in memory, column by column. Access by a name or type that the table does not have throws MisuseError.
class Table {
 public:
  Table() = default;
  Table(const TableSpec& spec, std::size_t rows);

  [[nodiscard]] const std::string& name() const noexcept { return _name; }
  [[nodiscard]] std::size_t rows() const noexcept { return _rows; }
  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return _columns; }
  [[nodiscard]] std::vector<Column>& columns() noexcept { return _columns; }
  [[nodiscard]] const Column& column(std::string_view name) const;
  [[nodiscard]] Column& column(std::string_view name);

  [[nodiscard]] const std::vector<std::int64_t>& integers(std::string_view name) const;
  [[nodiscard]] const std::vector<double>& reals(std::string_view name) const;
  [[nodiscard]] const std::vector<std::string>& texts(std::string_view name) const;
  [[nodiscard]] std::vector<std::int64_t>& integers(std::string_view name);
  [[nodiscard]] std::vector<double>& reals(std::string_view name);
  [[nodiscard]] std::vector<std::string>& texts(std::string_view name);

  /// The text widths of the columns put in, for writing.
  [[nodiscard]] TableSpec spec() const;

 private:
  std::string _name;
  std::size_t _rows = 0;
  std::vector<Column> _columns;
};

}  // namespace orbweaver::archive
