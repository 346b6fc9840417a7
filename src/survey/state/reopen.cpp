#include "reopen.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "branch_state.hpp"
#include "orbweaver/scene/differences.hpp"

namespace orbweaver::survey {

namespace {

/// The crossing's or family's key that a task is about: "locate KEY", "start KEY", or the branch's own.
std::string place_of(const std::string& task_key) {
  const std::size_t space = task_key.find(' ');
  return space == std::string::npos ? task_key : task_key.substr(space + 1);
}

}  // namespace

int widened_limits(const scene::Scene& before, const scene::Scene& now) {
  int limits = 0;
  for (const scene::Difference& difference : scene::differences(before, now)) {
    if (difference.change != scene::Change::widened) continue;
    if (difference.key == "limits.period") limits |= period_limited;
    if (difference.key == "limits.energy") limits |= energy_limited;
    if (difference.key == "limits.steps") limits |= step_limited;
    if (difference.key == "survey.depth") limits |= depth_limited;
    // limits.families: families left out wait in the checkpoint, and are asked again.
  }
  return limits;
}

bool Reopening::stays(const EndedTask& entry) {
  if (_widened == 0) return true;
  if (is_behind(entry.task.key)) {
    drop(entry.task);
    return false;
  }
  if (!is_limited(entry)) return true;
  reopen(entry);
  return false;
}

void Reopening::finish() {
  if (_widened == 0) return;
  for (std::vector<queue::Task>* tasks : {&_checkpoint.unfinished, &_checkpoint.left_out})
    std::erase_if(*tasks, [&](const queue::Task& task) {
      const bool dropped = is_behind(task.key);
      if (dropped) drop(task);
      return dropped;
    });
  _checkpoint.unfinished.insert(_checkpoint.unfinished.end(), _again.begin(), _again.end());
}

bool Reopening::is_behind(const std::string& key) const {
  const std::string place = place_of(key);
  const bool gone = std::any_of(_whole.begin(), _whole.end(), [&](const std::string& branch) {
    return place == branch || place.starts_with(branch + "/");
  });
  return gone || std::any_of(_behind.begin(), _behind.end(), [&](const Behind& behind) {
           const std::size_t length = behind.branch.size();
           return place.size() > length + 1 && place.compare(0, length, behind.branch) == 0 && place[length] == '/' &&
                  std::stoi(place.substr(length + 1)) >= behind.first_event;
         });
}

bool Reopening::is_limited(const EndedTask& entry) const {
  int limits = 0;
  if (entry.task.kind == start_kind) {
    if (!entry.had_children || entry.outcome.payload == limited_start) limits = period_limited | energy_limited;
  } else if (entry.outcome.payload.empty()) {
    return false;
  } else if (entry.task.kind == branch_kind) {
    limits = unpack_branch_outcome(entry.outcome.payload).limited_by;
  } else if (entry.task.kind == locate_kind) {
    limits = unpack_locate_outcome(entry.outcome.payload).limited_by;
  }
  return (limits & _widened) != 0;
}

void Reopening::reopen(const EndedTask& entry) {
  queue::Task task = entry.task;
  task.state.clear();
  if (task.kind == start_kind) _whole.push_back(place_of(task.key));
  if (task.kind == branch_kind) {
    task.state = unpack_branch_outcome(entry.outcome.payload).before_limit;
    int orbits = 0;
    int events = 0;
    if (!task.state.empty()) {
      const BranchState state = unpack_branch_state(task.state);
      orbits = state.outcome.orbits;
      events = state.events;
    }
    forget_rows(task, orbits);
    _behind.push_back({task.key, events});
  }
  _again.push_back(std::move(task));
}

void Reopening::drop(const queue::Task& task) {
  if (task.kind == branch_kind) forget_rows(task, 0);
}

/// The orbits of a branch from its `from`-th on.
void Reopening::forget_rows(const queue::Task& branch, int from) {
  const Lineage lineage = unpack_branch_work(branch.payload).lineage;
  archive::VoidedRows rows;
  rows.family_key = lineage.family;
  rows.before_segment = static_cast<int>(_checkpoint.segments.size());
  if (lineage.side > 0)
    rows.first_step = from;
  else
    rows.last_step = -1 - from;
  if (rows.before_segment > 0) _checkpoint.voided.push_back(std::move(rows));
}

}  // namespace orbweaver::survey
