#pragma once

#include <string>

#include "tasks/payload/doubtful_orbits.hpp"

namespace orbweaver::survey {

/// "certificates of 3 orbits say nothing: ...", for the summary.
[[nodiscard]] std::string doubt_text(const DoubtfulOrbits& doubtful);

}  // namespace orbweaver::survey
