#pragma once

#include <cstddef>
#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Where the family is linearly stable, in periods: "stable T 8.44 .. 9.1, 12 .. 12.3", "stable", "unstable", or ""
/// where nothing is known. Neighbouring orbits that are stable make an interval from the period of the first to that of
/// the last, or of the crossings that were located between these and their neighbours. Where T is one number and a
/// parameter moves, as under a drive, in that: "stable F 0 .. 0.3". Intervals run along the family: where T turns in
/// one, the turns stand between its ends in that order ("25.27 .. 25.3 .. 25.26"), up to three. Where T turns on the
/// family at all, or does not change, it has the steps of its first and last orbit behind it. An orbit is stable if
/// within `stability_error` all its indices are real and between -2 and 2, or all its multipliers within the unit
/// circle; one of which an error above 1e-3 leaves that open is not classified. What is not stable interrupts an
/// interval.
[[nodiscard]] std::string stability_text(const archive::Archive& atlas, std::size_t family);

}  // namespace orbweaver::report
