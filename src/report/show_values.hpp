#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"
#include "table_view.hpp"

namespace orbweaver::report {

// The flat forms of a table (show.hpp says what stands in them).
void print_csv(std::ostream& out, const archive::Header& header, const TableView& view);
void print_json(std::ostream& out, const TableView& view);
void print_readable(std::ostream& out, const archive::Archive& atlas, const TableView& view);

/// Leaves out what no reader asks for unnamed: where modes lie in the archive, and columns without any value.
void drop_unread_columns(TableView& view);

}  // namespace orbweaver::report
