#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbweaver/continuation/ending.hpp"
#include "orbweaver/survey/tasks/work.hpp"

namespace orbweaver::survey {

/// How a branch of a family ended: as continuation::EndReason, or at another family.
enum class EndKind {
  period_limit,
  energy_limit,
  step_limit,
  cutoff_limit,
  period_divergence,
  fixed_point,
  closed_loop,
  stopped,
  failure,
  met,      ///< at a crossing of a family of more symmetry where nothing was followed
  joined,   ///< the family that was found from there
  unknown,  ///< of an archive from another version
};

// Texts of ends, for people and for the column end_reason of /families.

/// "period limit (T = 30)", "met a family of more symmetry (T = 8, E = 1)".
[[nodiscard]] std::string end_text(const BranchOutcome& outcome);
/// "failure (WHY)", of a branch without an outcome.
[[nodiscard]] std::string failure_text(const std::string& why);
/// "joined NAME at T = 24 (crossing at T = 8, 3 times around)".
[[nodiscard]] std::string joined_text(const std::string& name, const LocateOutcome& crossing);
/// Of a family with two branches.
[[nodiscard]] std::string both_ends_text(const std::string& forwards, const std::string& backwards);

/// The ends in a text that these functions made, two for a family with two branches: for archives that are read.
[[nodiscard]] std::vector<EndKind> ends_in(std::string_view end_reason);

}  // namespace orbweaver::survey
