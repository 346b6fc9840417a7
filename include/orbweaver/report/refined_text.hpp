#pragma once

#include <string>
#include <utility>
#include <vector>

#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::report {

/// Lines of what an orbit is, a label and a text each, before its numbers.
using RefinedLabels = std::vector<std::pair<std::string, std::string>>;

/// An orbit to many digits as a text: every number rounded to its digits, with a bound on the error of what is printed.
/// `title`: one line. Ends with a line feed.
[[nodiscard]] std::string refined_text(const std::string& title, const RefinedLabels& labels,
                                       const systems::System& system, const refine::RefinedOrbit& orbit);

}  // namespace orbweaver::report
