#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Lines of readable text are not longer, where words allow it.
inline constexpr std::size_t line_width = 120;

// The flat forms of a table (show.hpp says what stands in them).
void print_csv(std::ostream& out, const archive::Header& header, const archive::Table& table);
void print_json(std::ostream& out, const archive::Table& table);
void print_readable(std::ostream& out, const archive::Header& header, const archive::Table& table);

/// The tree of families: children behind their parent, indented, in the order of their rows.
void print_families(std::ostream& out, const archive::Archive& atlas);
void print_crossings(std::ostream& out, const archive::Archive& atlas);

/// "2 .. 5.5": least and greatest of values[first] ... values[first + count - 1]; "-" if none is a number.
[[nodiscard]] std::string range_text(const std::vector<double>& values, std::size_t first, std::size_t count);

/// Where the family is linearly stable, in periods: "stable T 8.44 .. 9.1, 12 .. 12.3", "stable", "unstable", or ""
/// where nothing is known. Neighbouring orbits that are stable make an interval from the period of the first to that of
/// the last, or of the crossings that were located between these and their neighbours. An orbit is stable if within
/// `stability_error` all its indices are real and between -2 and 2, or all its multipliers within the unit circle; one
/// whose error exceeds 1e-3 is not classified and interrupts an interval.
[[nodiscard]] std::string stability_text(const archive::Archive& atlas, std::size_t family);

/// "period-doubling T 8.44293": row `crossing` of /crossings.
[[nodiscard]] std::string crossing_text(const archive::Archive& atlas, std::size_t crossing);

}  // namespace orbweaver::report
