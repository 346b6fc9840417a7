#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

// The flat forms of a table (show.hpp says what stands in them).
void print_csv(std::ostream& out, const archive::Header& header, const archive::Table& table);
void print_json(std::ostream& out, const archive::Table& table);
void print_readable(std::ostream& out, const archive::Header& header, const archive::Table& table);

}  // namespace orbweaver::report
