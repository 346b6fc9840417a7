#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/show.hpp"

namespace orbweaver::report {

/// What is shown of a table: `rows` of it in this order, and these columns.
struct TableView {
  struct Shown {
    const archive::Column* column;
    std::string name;       ///< the column's, or that of one of its values: state_th1
    std::size_t first = 0;  ///< of the values in a row
    std::size_t count = 1;

    [[nodiscard]] bool is_whole() const { return count == column->spec.width(); }
  };

  std::vector<Shown> columns;
  std::vector<std::size_t> rows;
};

/// Name of value `index` within a row of a column, with several values: state_th1, winding_n1, stability_0_re.
[[nodiscard]] std::string value_name(const archive::Header& header, const archive::ColumnSpec& spec, std::size_t index);

/// Without columns: all but the checksums, which an archive has been held against when it was opened. Throws
/// InputError for families and columns that are not there, and sorting by a column with several values.
[[nodiscard]] TableView view_of(const archive::Archive& atlas, const archive::Table& table, const Selection& selection);

}  // namespace orbweaver::report
