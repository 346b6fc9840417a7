#include "reopen.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "branch_state.hpp"
#include "orbweaver/scene/differences.hpp"
#include "payload_store.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

int limits_of(const EndedTask& entry) {
  const std::string& outcome = entry.outcome.payload;
  switch (kind_of(entry.task)) {
    case TaskKind::branch: return outcome.empty() ? 0 : unpack_branch_outcome(outcome).limited_by;
    case TaskKind::locate: return outcome.empty() ? 0 : unpack_locate_outcome(outcome).limited_by;
    // One that failed may have been driven beyond a limit on the way.
    case TaskKind::start: return entry.had_children ? unpack_start_outcome(outcome).limited_by : orbit_limited;
    case TaskKind::locus: return outcome.empty() ? 0 : unpack_locus_outcome(outcome).limited_by;
    case TaskKind::sweep: break;
  }
  return 0;
}

int widened_limits(const scene::Scene& before, const scene::Scene& now) {
  int limits = 0;
  for (const scene::Difference& difference : scene::differences(before, now)) {
    if (difference.change != scene::Change::widened || !difference.limit) continue;
    switch (*difference.limit) {
      case scene::LimitKey::period: limits |= period_limited; break;
      case scene::LimitKey::energy: limits |= energy_limited; break;
      case scene::LimitKey::parameter: limits |= parameter_limited; break;
      case scene::LimitKey::guards: limits |= guard_limited; break;
      case scene::LimitKey::steps: limits |= step_limited; break;
      case scene::LimitKey::depth: limits |= depth_limited; break;
      case scene::LimitKey::families: break;  // families left out wait in the checkpoint, and are asked again
    }
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
  for (queue::Task& task : _checkpoint.unfinished) go_back(task);
  _checkpoint.unfinished.insert(_checkpoint.unfinished.end(), _again.begin(), _again.end());
}

bool Reopening::is_behind(const std::string& key) const {
  const std::string place = place_of(key);
  const bool gone = std::any_of(_whole.begin(), _whole.end(),
                                [&](const std::string& branch) { return place == branch || lies_on(place, branch); });
  return gone || std::any_of(_behind.begin(), _behind.end(), [&](const Behind& behind) {
           return lies_on(place, behind.branch) && event_number(place, behind.branch) >= behind.first_event;
         });
}

bool Reopening::is_limited(const EndedTask& entry) const { return (limits_of(entry) & _widened) != 0; }

void Reopening::reopen(const EndedTask& entry) {
  queue::Task task = entry.task;
  task.state.clear();
  if (kind_of(task) == TaskKind::start) _whole.push_back(place_of(task.key));
  if (kind_of(task) == TaskKind::branch) {
    task.state = whole_payload(_folder, unpack_branch_outcome(entry.outcome.payload).before_limit);
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

/// A branch that has not ended, but came by a limit, which it will not meet there any more.
void Reopening::go_back(queue::Task& running) {
  if (kind_of(running) != TaskKind::branch || running.state.empty()) return;
  const BranchState now = unpack_branch_state(running.state);
  if ((now.outcome.limited_by & _widened) == 0) return;
  int orbits = 0;
  running.state.clear();
  if (!now.outcome.before_limit.empty()) {
    BranchState before = unpack_branch_state(whole_payload(_folder, now.outcome.before_limit));
    orbits = before.outcome.orbits;
    for (const queue::Task& child : now.children)
      if (event_number(place_of(child.key), running.key) < before.events) before.children.push_back(child);
    running.state = pack(before);
  }
  forget_rows(running, orbits);
}

void Reopening::drop(const queue::Task& task) {
  if (kind_of(task) == TaskKind::branch) forget_rows(task, 0);
}

/// The orbits of a branch from its `from`-th on.
void Reopening::forget_rows(const queue::Task& branch, int from) {
  const Lineage lineage = told_branch(branch).lineage;
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
