#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/scales.hpp"

namespace orbweaver::survey {

/// A task that has ended, as it is kept on disk; the children are tasks of their own.
struct EndedTask {
  queue::Task task;
  queue::TaskOutcome outcome;  ///< without children
  bool had_children = false;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, task, outcome, had_children);
  }
};

/// A file of tasks that ended between two flushes, in the order in which they did.
struct JournalFile {
  std::string name;
  std::size_t entries = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, name, entries);
  }
};

/// How far a survey has come.
enum class Stage {
  sweeps,    ///< looking for small oscillations
  families,  ///< following what was found
  finished,  ///< the archive is written
};
[[nodiscard]] constexpr Stage last_of(Stage) { return Stage::finished; }

/// Everything from which a survey goes on: with the segments and journals that it lists.
struct Checkpoint {
  static constexpr const char* payload_name = "checkpoint";
  std::string orbweaver_version;
  std::string scene;
  std::string model;                        ///< scene::Scene::model
  systems::Scales scales;                   ///< in which the tasks are told
  std::vector<std::string> earlier_scenes;  ///< before limits were widened, for which segments may have been written
  Stage stage = Stage::sweeps;
  std::size_t failures = 0;  ///< of a finished survey
  std::vector<archive::WrittenSegment> segments;
  std::vector<JournalFile> journals;
  std::vector<archive::VoidedRows> voided;
  std::vector<queue::Task> unfinished;  ///< waiting and running ones, with their states
  std::vector<queue::Task> left_out;    ///< not wanted so far

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, orbweaver_version, scene, model, scales, earlier_scenes, stage, failures, segments,
                            journals, voided, unfinished, left_out);
  }
};

/// Where a survey keeps what it needs to go on: segments, journals, and the last two checkpoints.
[[nodiscard]] std::filesystem::path state_folder(const std::filesystem::path& directory);
[[nodiscard]] std::filesystem::path checkpoint_path(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path previous_checkpoint_path(const std::filesystem::path& folder);

/// By which a checkpoint that is written is known again.
struct CheckpointMark {
  std::size_t bytes = 0;
  std::size_t hash = 0;
  friend bool operator==(const CheckpointMark&, const CheckpointMark&) = default;
};

/// Makes `checkpoint` the folder's newest; the one before stays as the previous one. One that is `newest`, which the
/// folder's newest is, stays as it is: with a million harmonics it has 300 MB. Throws EnvironmentError.
CheckpointMark write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint,
                                const CheckpointMark& newest = {});
/// Throws InputError for a file that is absent, torn, damaged, or of a newer version.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

/// A number for a journal that no listed one has.
[[nodiscard]] std::size_t next_journal(const Checkpoint& checkpoint);
[[nodiscard]] JournalFile write_journal(const std::filesystem::path& folder, std::size_t number,
                                        const std::vector<EndedTask>& entries);
/// Throws InputError, also if the file has other entries than listed.
[[nodiscard]] std::vector<EndedTask> read_journal(const std::filesystem::path& folder, const JournalFile& file);

/// The scene of a checkpoint. Throws InputError where this Orbweaver does not read it.
[[nodiscard]] scene::Scene scene_of(const Checkpoint& checkpoint);

}  // namespace orbweaver::survey
