#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The system with its effects, the values of its parameters with units, and the units of what the tables hold.
void print_head(std::ostream& out, const archive::Archive& atlas, std::size_t width);

}  // namespace orbweaver::report
