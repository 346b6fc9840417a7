#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The readable form of /equilibria: a line a point.
void print_equilibria(std::ostream& out, const archive::Archive& atlas);

}  // namespace orbweaver::report
