#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "family_tree.hpp"
#include "orbweaver/queue/observer.hpp"
#include "time_limit.hpp"

namespace orbweaver::survey {

/// Passes everything on to the display, and minds the time.
class Recorder : public queue::Observer {
 public:
  Recorder(queue::Observer& display, TimeLimit& time) : _display(display), _time(time) {}

  void started(const queue::Task& task, int rank) override { _display.started(task, rank); }
  void progress(const queue::Task& task, const queue::Progress& p, int rank) override {
    _display.progress(task, p, rank);
  }
  void finished(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    keep(task, outcome);
    _display.finished(task, outcome);
  }
  void failed(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    keep(task, outcome);
    _display.failed(task, outcome);
  }
  // Its rows are kept, and so must the family be.
  void stopped(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    keep(task, outcome);
    _display.stopped(task, outcome);
  }
  void tick(const queue::TaskCounts& counts) override {
    _time.tick();
    _display.tick(counts);
  }

 protected:
  virtual void keep(const queue::Task& task, const queue::TaskOutcome& outcome) = 0;

 private:
  queue::Observer& _display;
  TimeLimit& _time;
};

/// Keeps the outcomes of sweeps.
class SweepRecorder : public Recorder {
 public:
  using Recorder::Recorder;
  /// Tasks with their outcomes in order of keys.
  [[nodiscard]] const std::map<std::string, std::pair<queue::Task, queue::TaskOutcome>>& ended() const {
    return _ended;
  }

 private:
  void keep(const queue::Task& task, const queue::TaskOutcome& outcome) override {
    _ended.insert_or_assign(task.key, std::pair(task, outcome));
  }
  std::map<std::string, std::pair<queue::Task, queue::TaskOutcome>> _ended;
};

/// Grows the tree of families.
class TreeRecorder : public Recorder {
 public:
  TreeRecorder(queue::Observer& display, TimeLimit& time, FamilyTree& tree) : Recorder(display, time), _tree(tree) {}
  bool wanted(const queue::Task& task) override { return _tree.wanted(task); }
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
  std::vector<queue::Task> _left_out;
};

}  // namespace orbweaver::survey
