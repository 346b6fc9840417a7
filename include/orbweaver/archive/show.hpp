#pragma once

#include <ostream>
#include <string>

#include "orbweaver/archive/reader.hpp"

namespace orbweaver::archive {

enum class TextFormat { readable, csv, json };

/// The tables that can be shown by name: "families", "orbits", "crossings". Throws InputError for another name.
[[nodiscard]] const Table& shown_table(const Archive& atlas, const std::string& name);

/// What the atlas holds: the program and format that wrote it, the coordinates, the number of rows, the ranges of
/// period and energy, and a line a family.
void print_summary(std::ostream& out, const Archive& atlas);

/// One table. Readable: aligned columns with ten digits; of families, indices are replaced by names and the ranges of
/// period and energy added. CSV: a head line, then full precision (%.17g), vector columns spread out as
/// column_coordinate, what was not computed as `nan`. JSON: one array of objects with full precision, vector columns as
/// arrays, what was not computed as `null`.
void print_table(std::ostream& out, const Archive& atlas, const std::string& name, TextFormat format);

}  // namespace orbweaver::archive
