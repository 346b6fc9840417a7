#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

enum class TextFormat { readable, csv, json };

/// What readable text is written for.
struct Layout {
  std::size_t width = 120;  ///< columns; lines are not longer, where words allow it
  bool unicode = false;     ///< whether it may have characters beyond ASCII of its own
};

/// Rows and columns of a table.
struct Selection {
  std::string family;                ///< rows of the family of this name only
  std::vector<std::string> columns;  ///< columns, or values of one such as state_th1, in this order; none: all
  std::string sort;                  ///< by this column or value, downwards behind a `-`; none: as they are stored
  bool all_equilibria = false;       ///< in readable text, not only those at which something is

  [[nodiscard]] bool empty() const { return family.empty() && columns.empty() && sort.empty(); }
};

/// The tables that can be shown by name: "families", "orbits", "crossings", "loci", "equilibria", "findings". Throws
/// InputError for another name.
[[nodiscard]] const archive::Table& shown_table(const archive::Archive& atlas, const std::string& name);

/// What the atlas holds: the program and format that wrote it, the system with parameters and units, the coordinates,
/// the number of rows, the ranges of period and energy, and the tree of families.
void print_summary(std::ostream& out, const archive::Archive& atlas, const Layout& layout = {});

/// What stands before a readable table: the system, its parameters, and the units of the numbers.
void print_table_head(std::ostream& out, const archive::Archive& atlas, const Layout& layout = {});

/// One table, or a selection of it. Readable: aligned columns with ten digits and the families' names, unless columns
/// are chosen without those that have no value and those that say where modes lie in the archive; crossings, unless
/// columns are chosen, with their rows, names in place of indices, who is born and who ends there; without a selection
/// loci with names in place of indices; equilibria with their periods, and of their curves, unless all are asked for,
/// only ends, Hopf points, folds and what else is notable, with the number of those left out; findings in a line each,
/// as sentences; families as the tree in lines of at most the layout's width, children indented behind their parent,
/// each with the crossing it was born at (kind, period, m), its ranges of period and energy, stability along it drawn
/// in a few characters where the width allows it, isotropy, intervals of stability, and why it ended, cut where it is
/// long. CSV: a head line, then full precision (%.17g), vector columns spread out as column_coordinate, what was not
/// computed as `nan`. JSON: one array of objects with full precision, vector columns as arrays, what was not computed
/// as `null`. Throws InputError for a table, family or column that is not there.
void print_table(std::ostream& out, const archive::Archive& atlas, const std::string& name, TextFormat format,
                 const Selection& selection = {}, const Layout& layout = {});

}  // namespace orbweaver::report
