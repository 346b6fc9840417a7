#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace orbweaver::survey {

/// What a finding means for the survey.
enum class Severity {
  contradiction,  ///< two parts of the tree cannot both be right
  failure,        ///< a task could not be done
  undecided,      ///< double precision, or what the survey knows, does not tell
  cut,            ///< a limit of the scene ended it
};
/// "contradiction", ...: as in the archive.
[[nodiscard]] std::string_view name_of(Severity severity);
/// Whether a survey with such a finding has missed its goal (exit status 1).
[[nodiscard]] constexpr bool is_wrong(Severity severity) {
  return severity == Severity::contradiction || severity == Severity::failure;
}

/// What does not add up (docs/file_format.md, /findings). `number` and `other_number` of a finding are what the text
/// says of each.
enum class FindingKind {
  duplicate_curve,       ///< two families hold the same orbits: number of other_number that were compared
  retraced_curve,        ///< a family runs over its own orbits, or their images, again: as duplicate_curve
  shared_point,          ///< a family passes through the crossing, of which nothing says so
  missing_directions,    ///< the kernel has other_number directions, number were found; or there may be others
  unfollowed_direction,  ///< a direction that nobody left or arrived along; number: which
  beyond_depth,          ///< nothing was looked for: survey.depth
  beyond_period,         ///< nothing was looked for: limits.period
  beyond_order,          ///< nothing was looked for: survey.subharmonics
  beyond_limits,         ///< a direction along which the first orbit lies beyond limits
  beyond_families,       ///< a direction that limits.families left out
  equilibrium_families,  ///< indices of what leaves an equilibrium add up to number, not other_number
  base_birth,            ///< does not begin at its equilibrium with the period of its oscillation
  continuum,             ///< number orbits found at an equilibrium are not isolated
  unlisted_target,       ///< ends at a crossing that the archive does not have
  taken_direction,       ///< ends where it was born, at a crossing whose directions all have a family without that end
  unknown_direction,     ///< ends near the crossing, along none of its directions
  higher_order,          ///< ends on the other family gone around number times, more than survey.subharmonics
  unlisted_crossing,     ///< ends on the other family gone around number times, which has no crossing there
  unknown_family,        ///< ends on a family of more symmetry that the survey does not have
  unknown_branch,        ///< another curve of equilibria, in `detail`, that the survey does not have
  unknown_equilibrium,   ///< ends at an equilibrium that the survey does not have
  limited_end,           ///< a limit of the scene
  mirror_crossings,      ///< its mirror image has other_number crossings, it number
  mirror_place,          ///< a crossing of its mirror image lies elsewhere
  mirror_end,            ///< its mirror image ends otherwise, or elsewhere
  open_place,            ///< rounding leaves the place of the crossing open by `deviation` in arclength
  index_change,          ///< the index passes exp(2 pi i number/other_number), where no crossing is listed
  undecided_end,         ///< ends where orbits are not told from their neighbours
  undecided_event,       ///< in `detail`: not located, where orbits are not told from their neighbours
  undecided_indices,     ///< an index is known to `deviation` only, too badly to tell what it passes
  failed_certificate,    ///< number of other_number orbits have the verdict `detail`; the first of them
  silent_certificate,    ///< the same: the integration says nothing of them
  failed_task,           ///< in `detail`
  disputed_arrival,      ///< arrivals contradict each other
  interrupted,           ///< put aside, or not begun before limits.time
};
[[nodiscard]] constexpr FindingKind last_of(FindingKind) { return FindingKind::interrupted; }
/// "duplicate-curve", ...: as in the archive.
[[nodiscard]] std::string_view name_of(FindingKind kind);

/// One thing that does not add up, or that a limit cut. Families and crossings are rows of the archive, -1: none.
struct Finding {
  FindingKind kind = FindingKind::failed_task;
  Severity severity = Severity::failure;
  int family = -1;
  int other_family = -1;
  int crossing = -1;
  double period = std::numeric_limits<double>::quiet_NaN();
  double level = std::numeric_limits<double>::quiet_NaN();      ///< energy, or the parameter that moves
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< how far off (docs/file_format.md says in what)
  int number = 0;
  int other_number = 0;
  std::string detail{};  ///< what a task said of its failure, the verdict, or why it is undecided
};

/// The names that a text about a finding needs.
struct FindingNames {
  std::string family;
  std::string other_family;
  std::string crossing;     ///< "period-doubling T 8.44293"
  std::string level = "E";  ///< or the parameter's
};
/// "In-Phase: ...", a sentence without a full stop.
[[nodiscard]] std::string text_of(const Finding& finding, const FindingNames& names);

}  // namespace orbweaver::survey
