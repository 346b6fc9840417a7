#include "checkpoint_keeper.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/log/log.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

namespace {

/// The payload of a location is large, and needed again under wider limits only.
bool may_be_done_again(const EndedTask& entry) {
  return kind_of(entry.task) != TaskKind::locate || entry.outcome.payload.empty() ||
         unpack_locate_outcome(entry.outcome.payload).limited_by != 0;
}

}  // namespace

void CheckpointKeeper::ended(const queue::Task& task, const queue::TaskOutcome& outcome) {
  EndedTask entry;
  entry.task = {task.key, task.priority, task.kind, task.payload, {}};
  entry.outcome.key = outcome.key;
  entry.outcome.failed = outcome.failed;
  entry.outcome.reason = outcome.reason;
  entry.outcome.payload = outcome.payload;
  entry.had_children = !outcome.children.empty();
  if (!may_be_done_again(entry)) entry.task.payload.clear();
  _ended.push_back(std::move(entry));
}

void CheckpointKeeper::take(const queue::TaskQueue& queue, const std::vector<queue::Task>& left_out) {
  _checkpoint.unfinished = queue.unfinished();
  _checkpoint.left_out = left_out;
  for (EndedTask& entry : _ended) _taken.push_back(std::move(entry));
  _ended.clear();
}

void CheckpointKeeper::commit(const std::vector<archive::WrittenSegment>& segments) {
  const auto began = std::chrono::steady_clock::now();
  if (!_taken.empty()) {
    _checkpoint.journals.push_back(write_journal(_folder, next_journal(_checkpoint), _taken));
    _taken.clear();
  }
  _checkpoint.segments = segments;
  _newest = write_checkpoint(_folder, _checkpoint, _newest);
  const std::size_t in_flight = _checkpoint.unfinished.size();
  // The queue has them; what is left is what an archive needs of branches that a stop has cut.
  std::erase_if(_checkpoint.unfinished, [](const queue::Task& task) { return task.state.empty(); });
  const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - began;
  core::log_debug(fmt::format("checkpoint: {} tasks in flight, {} journals, {} segments; {} bytes in {:.1f} ms",
                              in_flight, _checkpoint.journals.size(), segments.size(),
                              std::filesystem::file_size(checkpoint_path(_folder)), passed.count()));
}

void CheckpointKeeper::finish(std::size_t failures) {
  _checkpoint.stage = Stage::finished;
  _checkpoint.failures = failures;
  write_checkpoint(_folder, _checkpoint);
}

}  // namespace orbweaver::survey
