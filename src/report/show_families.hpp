#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/show.hpp"

namespace orbweaver::report {

/// The tree of families: children behind their parent, indented, in the order of their rows.
void print_families(std::ostream& out, const archive::Archive& atlas, const Layout& layout);

/// "2 .. 5.5": least and greatest of values[first] ... values[first + count - 1]; "-" if none is a number.
[[nodiscard]] std::string range_text(const std::vector<double>& values, std::size_t first, std::size_t count);

}  // namespace orbweaver::report
