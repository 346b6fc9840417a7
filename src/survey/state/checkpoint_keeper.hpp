#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "checkpoint.hpp"
#include "orbweaver/queue/task_queue.hpp"

namespace orbweaver::survey {

/// Rank 0's part of a flush: gathers what has ended, takes the state of the run while all ranks stand still, and writes
/// it when their rows are safe. Holds what is in flight; what has ended is in the journals.
class CheckpointKeeper {
 public:
  /// `last`: where the survey stands, as far as it has come; its lists are carried on.
  CheckpointKeeper(std::filesystem::path folder, Checkpoint last)
      : _folder(std::move(folder)), _checkpoint(std::move(last)) {}

  void set_stage(Stage stage) { _checkpoint.stage = stage; }
  /// A task has ended for good.
  void ended(const queue::Task& task, const queue::TaskOutcome& outcome);
  /// All ranks stand still: this is the state of the run.
  void take(const queue::TaskQueue& queue, const std::vector<queue::Task>& left_out);
  /// The rows of that state are safe, in `segments`: writes it. Throws EnvironmentError.
  void commit(const std::vector<archive::WrittenSegment>& segments);
  /// The survey is over and its archive written.
  void finish(std::size_t failures);

  /// The last checkpoint; of the tasks that had not ended, those that have a state.
  [[nodiscard]] const Checkpoint& last() const { return _checkpoint; }

 private:
  std::filesystem::path _folder;
  Checkpoint _checkpoint;
  CheckpointMark _newest;         // written by this keeper
  std::vector<EndedTask> _ended;  // since the last state taken
  std::vector<EndedTask> _taken;  // belongs to it, and is not written yet
};

}  // namespace orbweaver::survey
