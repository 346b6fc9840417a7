#include "checkpoint_keeper.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/log.hpp"

namespace orbweaver::survey {

void CheckpointKeeper::ended(const queue::Task& task, const queue::TaskOutcome& outcome) {
  EndedTask entry{task, outcome, !outcome.children.empty()};
  entry.task.state.clear();
  entry.outcome.children.clear();
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
  write_checkpoint(_folder, _checkpoint);
  const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - began;
  core::log_debug(fmt::format("checkpoint: {} tasks in flight, {} journals, {} segments; {} bytes in {:.1f} ms",
                              _checkpoint.unfinished.size(), _checkpoint.journals.size(), segments.size(),
                              std::filesystem::file_size(checkpoint_path(_folder)), passed.count()));
}

void CheckpointKeeper::finish(std::size_t failures) {
  _checkpoint.stage = Stage::finished;
  _checkpoint.failures = failures;
  write_checkpoint(_folder, _checkpoint);
}

}  // namespace orbweaver::survey
