#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// These crossings, each with its row in the table, and names of families in place of indices.
void print_crossings(std::ostream& out, const archive::Archive& atlas, const std::vector<std::size_t>& rows);

/// "period-doubling T 8.44293", "fold-parameter T 5.23599, drive_amplitude 0.4": row `crossing` of /crossings.
[[nodiscard]] std::string crossing_text(const archive::Archive& atlas, std::size_t crossing);

}  // namespace orbweaver::report
