#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbweaver::survey {

/// How a branch of a family ended: as continuation::EndReason, or at another family.
enum class EndKind {
  period_limit,
  energy_limit,
  parameter_limit,
  guard_limit,
  step_limit,
  cutoff_limit,
  period_divergence,
  collision,
  fixed_point,
  closed_loop,
  strong_resonance,  ///< of loci only, as the next
  more_symmetry,
  stopped,
  undecided,
  failure,
  met,      ///< at a crossing of a family of more symmetry where nothing was followed
  joined,   ///< the family that was found from there
  unknown,  ///< of an archive from another version
};

/// "period limit", "joined".
[[nodiscard]] std::string_view name_of(EndKind kind);

/// The text of /families' column end_reason for a family with two branches, from those of its branches.
[[nodiscard]] std::string both_ends_text(const std::string& forwards, const std::string& backwards);

/// The ends in an end_reason, two for a family with two branches: for archives that are read.
[[nodiscard]] std::vector<EndKind> ends_in(std::string_view end_reason);

}  // namespace orbweaver::survey
