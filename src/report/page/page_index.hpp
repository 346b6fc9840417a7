#pragma once

#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The coordinates that may wind, in the order of the header's winding_names: those of the system, or the first ones
/// where the program does not know it.
[[nodiscard]] std::vector<int> angles_of(const archive::Header& header);

/// What a page knows of an archive but for its orbits, as members of a JSON object without the braces: the system,
/// /families, /crossings and /findings, names of verdicts, whether stability values are multipliers.
[[nodiscard]] std::string index_members(const archive::Archive& atlas);

}  // namespace orbweaver::report
