#pragma once

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/witness/finding.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// One family as the summary shows it.
struct FamilySummary {
  std::string key;
  std::string name;
  std::string isotropy;
  int orbits = 0;
  double period_from = 0.0;
  double period_to = 0.0;
  double level_from = 0.0;  ///< energy or parameter
  double level_to = 0.0;
  std::string end_reason;
  bool failed = false;
  int depth = 0;         ///< 0 for base families
  std::string doubts{};  ///< "2 of 30 orbits: closure contradicts", of certificates that do not hold; else empty
};

/// One thing that does not add up, or that a limit cut (docs/file_format.md, /findings).
struct FindingSummary {
  Severity severity = Severity::failure;
  FindingKind kind = FindingKind::failed_task;
  std::string text;
};

/// What a survey came to; complete on rank 0, `failures` and `stopped_early` on all ranks.
struct Summary {
  std::vector<FamilySummary> families;  ///< by depth, then key
  std::string parameter{};              ///< that moves along the families; empty: none, and their level is the energy
  std::vector<std::string> remarks;     ///< equilibria without oscillations, limits that cut
  std::vector<std::string> passed_over{};  ///< dips of sweeps that begin no family: repetitions of oscillations
  std::vector<std::string> failed_tasks;   ///< key and reason
  std::vector<FindingSummary> findings;    ///< by severity; empty where no archive was made
  std::size_t failures = 0;                ///< failed tasks and contradictions
  bool stopped_early = false;
  bool archived = false;  ///< whether `atlas` was written
  long orbits = 0;
  long crossings = 0;
  double seconds = 0.0;
  std::vector<double> peak_memory_mib;  ///< one a rank
  std::filesystem::path atlas;
};

/// How the survey talks while it runs.
enum class Display { none, lines, live };

struct RunOptions {
  Display display = Display::none;
  bool resume = false;  ///< go on from the directory's checkpoint, if there is one
  double walltime = std::numeric_limits<double>::infinity();  ///< seconds, after which the survey stops, resumable
  /// From when on it, limits.time and Summary::seconds count.
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

/// Surveys a scene into `directory`/atlas.h5: equilibria, sweeps, then every family found, as tasks of the queue
/// (docs/architecture.md). Collective over `comm`; works with any number of ranks, and the datasets of the archive have
/// the same bytes for all of them, also when it was broken off and resumed. Failed tasks are recorded and do not stop
/// the others. `directory`/segments holds what a resume needs, and stays for one with wider limits. A stop that was
/// asked for (queue::request_stop) or came by the wall time leaves a checkpoint and no archive, one by limits.time
/// both. `system` is the scene's system (systems::make_system). Throws InputError or EnvironmentError, on all ranks
/// alike, if the scene cannot be begun or a flush fails.
[[nodiscard]] Summary run_survey(const core::Communicator& comm, const scene::Scene& scene,
                                 const std::shared_ptr<const systems::System>& system,
                                 const std::filesystem::path& directory, const RunOptions& options);

/// Makes the archive of what a survey that was broken off has come to so far. Collective. Throws InputError if
/// `directory` holds no checkpoint that can be used.
[[nodiscard]] Summary archive_survey(const core::Communicator& comm, const std::filesystem::path& directory);

}  // namespace orbweaver::survey
