#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/queue/observer.hpp"
#include "run/segment_flusher.hpp"
#include "state/checkpoint_keeper.hpp"
#include "tree/base_families.hpp"
#include "tree/family_tree.hpp"

namespace orbweaver::survey {

/// What every recorder serves.
struct Recorded {
  queue::Observer& display;
  CheckpointKeeper& keeper;
  const SegmentFlusher& flusher;
};

/// Passes everything on to the display, and writes checkpoints.
class Recorder : public queue::Observer {
 public:
  explicit Recorder(const Recorded& to) : _to(to) {}

  void started(const queue::Task& task, int rank) override { _to.display.started(task, rank); }
  void progress(const queue::Task& task, const queue::Progress& p, int rank) override {
    _to.display.progress(task, p, rank);
  }
  void finished(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    keep(task, outcome);
    _to.keeper.ended(task, outcome);
    _to.display.finished(task, outcome);
  }
  void failed(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    keep(task, outcome);
    _to.keeper.ended(task, outcome);
    _to.display.failed(task, outcome);
  }
  void stopped(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    _to.display.stopped(task, outcome);
  }
  void flushing(int, const queue::TaskQueue& queue) override { _to.keeper.take(queue, left_out_tasks()); }
  void flushed(int) override { _to.keeper.commit(_to.flusher.written()); }
  void tick(const queue::TaskCounts& counts) override { _to.display.tick(counts); }
  [[nodiscard]] const std::vector<queue::Task>& left_out_tasks() const { return _left_out; }

 protected:
  virtual void keep(const queue::Task& task, const queue::TaskOutcome& outcome) = 0;
  std::vector<queue::Task> _left_out;

 private:
  Recorded _to;
};

/// Keeps the outcomes of sweeps.
class SweepRecorder : public Recorder {
 public:
  SweepRecorder(const Recorded& to, SweepsEnded& ended) : Recorder(to), _ended(ended) {}

 private:
  void keep(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    _ended.insert_or_assign(task.key, std::pair(task, outcome));
  }
  SweepsEnded& _ended;
};

/// Grows the tree of families.
class TreeRecorder : public Recorder {
 public:
  /// `left_out`: tasks that an earlier run has left out.
  TreeRecorder(const Recorded& to, FamilyTree& tree, std::vector<queue::Task> left_out) : Recorder(to), _tree(tree) {
    _left_out = std::move(left_out);
  }
  /// What has begun is ended: it has rows, and crossings may lie on it. The tree drops it in the end, if it has to.
  bool wanted(const queue::Task& task) override {
    return (kind_of(task) == TaskKind::branch && !task.state.empty()) || _tree.wanted(task);
  }
  void left_out(const queue::Task& task) override { _left_out.push_back(task); }
  /// Tasks left out that are wanted now that more is known; they are no longer among those left out.
  [[nodiscard]] std::vector<queue::Task> wanted_after_all() {
    const auto first = std::stable_partition(_left_out.begin(), _left_out.end(),
                                             [this](const queue::Task& task) { return !_tree.wanted(task); });
    std::vector<queue::Task> tasks(first, _left_out.end());
    _left_out.erase(first, _left_out.end());
    return tasks;
  }

 private:
  void keep(const queue::Task& task, const queue::TaskOutcome& outcome) override { _tree.add(task, outcome); }
  FamilyTree& _tree;
};

}  // namespace orbweaver::survey
