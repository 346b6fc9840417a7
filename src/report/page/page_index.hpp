#pragma once

#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// What a page knows of an archive but for its orbits, as members of a JSON object without the braces: the system,
/// /families, /crossings and /findings, names of verdicts, whether stability values are multipliers.
[[nodiscard]] std::string index_members(const archive::Archive& atlas);

}  // namespace orbweaver::report
