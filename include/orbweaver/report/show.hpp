#pragma once

#include <ostream>
#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

enum class TextFormat { readable, csv, json };

/// The tables that can be shown by name: "families", "orbits", "crossings", "loci", "equilibria", "findings". Throws
/// InputError for another name.
[[nodiscard]] const archive::Table& shown_table(const archive::Archive& atlas, const std::string& name);

/// What the atlas holds: the program and format that wrote it, the coordinates, the number of rows, the ranges of
/// period and energy, and the tree of families.
void print_summary(std::ostream& out, const archive::Archive& atlas);

/// One table. Readable: aligned columns with ten digits; crossings and loci with names in place of indices; equilibria
/// with their periods; findings in a line each, as sentences; families as the tree in lines of at most 120 characters,
/// children indented behind their parent, each with the crossing it was born at (kind, period, m), its ranges of period
/// and energy, isotropy, intervals of stability, and why it ended, cut where it is long. CSV: a head line, then full
/// precision (%.17g), vector columns
/// spread out as column_coordinate, what was not computed as `nan`. JSON: one array of objects with full precision,
/// vector columns as arrays, what was not computed as `null`.
void print_table(std::ostream& out, const archive::Archive& atlas, const std::string& name, TextFormat format);

}  // namespace orbweaver::report
