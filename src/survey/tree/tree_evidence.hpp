#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arrivals.hpp"
#include "family.hpp"
#include "pruning.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

/// What became of one side of a direction that leaves a crossing.
enum class DirectionFate {
  followed,
  arrived,  ///< a branch that stays has come along it
  failed,
  beyond_limits,    ///< its first orbit lies beyond the scene's limits
  beyond_families,  ///< limits.families
  hidden,           ///< by rounding
  unknown,
};

/// What the tree knows beyond its tables, for the survey's witness. Crossings are indices into the tables' crossings.
struct CrossingEvidence {
  int crossing = -1;
  int q = 1;
  int kernel_dimension = 0;
  int limited_by = 0;                ///< Limit
  bool failed = false;               ///< the task that looked for directions
  bool undecided = false;            ///< rounding decides which these are
  int directions = 0;                ///< found there
  std::vector<DirectionFate> sides;  ///< one a direction, or two
};

/// How a branch that stays ended.
struct EndEvidence {
  std::string family;  ///< its key
  int side = 1;
  bool failed = false;
  std::optional<continuation::Ending> end;  ///< none: the branch has no outcome
  bool met = false;                         ///< at a family of more symmetry,
  double period = 0.0;                      ///< here
  double level = 0.0;
  bool joined = false;      ///< it is known along which direction of which crossing it came
  int crossing = -1;        ///< that crossing, if the tables have it
  bool is_short = false;    ///< no orbit was found so near to there that its multipliers show the meeting
  std::vector<int> nearby;  ///< where it is not known: crossings that agree in period and energy, of orbits as near
};

struct FailureEvidence {
  std::string family;  ///< its key
  std::string reason;
};

struct TreeEvidence {
  std::vector<CrossingEvidence> crossings;
  std::vector<EndEvidence> ends;
  std::vector<FailureEvidence> failures;
  std::vector<FailureEvidence> failed_loci;  ///< what is known of the families stays as it is
  std::vector<FailureEvidence> undecided;  ///< events that rounding keeps from being located, or that were not found
  std::vector<std::string> disputed;       ///< keys of families
};

/// What a tree has to tell. `fate_of_unknown`: of the side of a direction whose branch has not ended.
struct TreeSources {
  const EndedBranches& branches;
  const Crossings& crossings;
  const std::map<std::string, std::string>& failed_locations;  ///< reasons by the crossing's key
  const std::map<std::string, std::string>& failed_loci;       ///< by the crossing's key and the scene's entry
  const std::map<std::string, std::string>& undecided_events;  ///< the same of events that rounding hides
  const Pruning& pruning;
  const Arrivals& arrivals;
  const std::vector<FamilySide>& kept;
  const std::map<std::string, int>& crossing_rows;  ///< indices into the tables' crossings by key
  const Units& units;                               ///< of the tasks' outcomes
  std::function<DirectionFate(const std::string& branch, const Lineage& lineage)> fate_of_unknown;
};
[[nodiscard]] TreeEvidence evidence_of(const TreeSources& tree);

}  // namespace orbweaver::survey
