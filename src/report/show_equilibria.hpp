#pragma once

#include <cstddef>
#include <ostream>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The readable form of /equilibria: a line each for these rows.
void print_equilibria(std::ostream& out, const archive::Archive& atlas, const std::vector<std::size_t>& rows);

/// Says how many rows are not among those that were `shown`, and how to have them. Nothing where all are.
void print_left_out_equilibria(std::ostream& out, const archive::Archive& atlas, std::size_t shown);

}  // namespace orbweaver::report
