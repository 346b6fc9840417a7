#pragma once

#include <string>

#include "tasks/payload/branch_work.hpp"
#include "tasks/payload/locate_work.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

// Texts of ends, for people and for the column end_reason of /families: each begins with the name of its EndKind.
// `units` are those of the outcomes' numbers.

/// "period limit (T = 30)", "met a family of more symmetry (T = 8, E = 1)".
[[nodiscard]] std::string end_text(const BranchOutcome& outcome, const Units& units = {});
/// "failure (WHY)", of a branch without an outcome.
[[nodiscard]] std::string failure_text(const std::string& why);
/// "joined NAME at T = 24 (crossing at T = 8, 3 times around)".
[[nodiscard]] std::string joined_text(const std::string& name, const LocateOutcome& crossing, const Units& units = {});

}  // namespace orbweaver::survey
