#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The points of all loci, one a line, with names in place of indices.
void print_loci(std::ostream& out, const archive::Archive& atlas);

}  // namespace orbweaver::report
