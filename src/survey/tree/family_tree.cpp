#include "family_tree.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "family_names.hpp"
#include "orbweaver/core/error.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

namespace {

/// Numbers of crossings that were placed at the end, beyond those of the events of any branch.
constexpr int first_placed = 1'000'000;
/// Relative difference in period of two crossings of one order on one family that are the same: far above what
/// locations are off, far below what others are away.
constexpr double same_period = 1e-7;

/// The families of branches, parents before children.
std::vector<Family> families_of(const std::vector<FamilySide>& branches) {
  std::map<std::tuple<int, std::string>, Family> families;  // by depth, then key
  for (const int side : {1, -1})
    for (const FamilySide branch : branches) {
      const Lineage& lineage = branch->second.lineage;
      if (lineage.side != side) continue;
      Family& family = families[{lineage.depth, lineage.family}];
      if (family.sides.empty()) family = {lineage.family, lineage, {}, branch->second.name};
      family.sides.push_back(branch);
      const std::optional<BranchOutcome>& outcome = branch->second.outcome;
      if (family.birth == 0.0 && outcome) family.birth = -outcome->before_first;
    }
  std::vector<Family> ordered;
  for (auto& [place, family] : families) ordered.push_back(std::move(family));
  return ordered;
}

/// Which given orbits lie on which families, and where: of each the first branch that has passed it.
std::vector<std::string> passed_texts(const std::vector<FamilySide>& kept,
                                      const std::map<std::string, std::string>& names, const Units& units) {
  std::map<std::string, std::string> texts;  // by the key of the family that would begin there
  for (const FamilySide branch : kept) {
    if (!branch->second.outcome) continue;
    for (const PassedStart& start : branch->second.outcome->passed) {
      texts.try_emplace(start.family, fmt::format("{}: {} lies on {}, at T = {:.9g}{}, and is no family of its own",
                                                  start.told, start.name, names.at(branch->second.lineage.family),
                                                  start.period, units.level_text(start.level)));
    }
  }
  std::vector<std::string> out;
  for (auto& [key, text] : texts) out.push_back(std::move(text));
  return out;
}

}  // namespace

void FamilyTree::add(const queue::Task& task, const queue::TaskOutcome& outcome) {
  const TaskKind kind = kind_of(task);
  if (kind == TaskKind::branch) {
    BranchWork work = told_branch(task);
    EndedBranch branch{std::move(work.lineage), std::move(work.name), std::move(work.isotropy), std::nullopt,
                       outcome.failed,          outcome.reason};
    if (!outcome.payload.empty()) branch.outcome = unpack_branch_outcome(outcome.payload);
    add_branch(task.key, std::move(branch));
  } else if (kind == TaskKind::start && outcome.failed) {
    BranchWork work = told_branch(task);
    add_branch(work.key, {std::move(work.lineage), std::move(work.name), std::move(work.isotropy), std::nullopt, true,
                          outcome.reason});
  } else if (kind == TaskKind::start && !outcome.stopped && outcome.children.empty()) {
    _not_begun.insert(place_of(task.key));
  } else if (kind == TaskKind::locate) {
    if (outcome.failed) _failures[place_of(task.key)] = outcome.reason;
    if (outcome.payload.empty()) return;
    LocateOutcome crossing = unpack_locate_outcome(outcome.payload);
    if (crossing.kind)
      add_crossing(std::move(crossing));
    else if (crossing.undecided)
      _undecided[place_of(task.key)] = std::move(crossing.remark);
  } else if (kind == TaskKind::locus) {
    if (outcome.failed) _locus_failures[place_of(task.key)] = outcome.reason;
    if (!outcome.payload.empty()) _loci.insert_or_assign(place_of(task.key), unpack_locus_outcome(outcome.payload));
  }
}

void FamilyTree::add_branch(const std::string& key, EndedBranch branch) {
  std::vector<Meeting> meetings;
  std::vector<std::string> passed;
  if (branch.outcome) {
    for (const PassedStart& start : branch.outcome->passed) passed.push_back(start.family);
    // All around a circle one side comes to where the other begins.
    if (branch.outcome->end.reason == continuation::EndReason::closed_loop) passed.push_back(branch.lineage.family);
    branch.outcome->before_limit = {};  // a journal has it
    for (ArrivalRecord& arrival : branch.outcome->arrival) {
      meetings = _arrivals.add_branch(key, arrival);
      arrival.near = {};
      arrival.nearest = {};
    }
  }
  const auto [place, is_new] = _branches.try_emplace(key, std::move(branch));
  core::require(is_new, "a branch ends once, and one ended again");
  std::vector<std::string> changed = _pruning.add_branch(key, place->second.lineage, meetings, passed);
  changed.push_back(key);
  count(changed);
}

void FamilyTree::add_crossing(LocateOutcome crossing) {
  core::require(!_crossings.contains(crossing.key), "a crossing is located once, and one was located again");
  if (!crossing.leaving.empty()) count(_pruning.add_meetings(_arrivals.add_crossing(crossing)));
  for (LeavingRecord& leaving : crossing.leaving) {
    leaving.base = {};
    leaving.direction = {};
    leaving.opposite = {};
  }
  std::string key = crossing.key;
  _crossings.emplace(std::move(key), std::move(crossing));
}

void FamilyTree::count(const std::vector<std::string>& branches) {
  for (const std::string& key : branches) {
    const Lineage& lineage = _branches.at(key).lineage;
    _limit.count({lineage.depth, key}, lineage.family, !_pruning.is_dropped(key));
  }
}

bool FamilyTree::wanted(const queue::Task& task) const {
  const TaskKind kind = kind_of(task);
  if (kind != TaskKind::branch && kind != TaskKind::start) return true;
  const BranchWork work = told_branch(task);
  return !_pruning.would_be_dropped(work.key, work.lineage) &&
         (work.lineage.depth == 0 || _limit.has_room({work.lineage.depth, work.key}, work.lineage.family));
}

std::vector<FamilySide> FamilyTree::kept_branches() const {
  std::vector<FamilySide> ordered;
  for (const auto& entry : _branches)
    if (!_pruning.is_dropped(entry.first)) ordered.push_back(&entry);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](FamilySide a, FamilySide b) { return a->second.lineage.depth < b->second.lineage.depth; });
  std::vector<FamilySide> kept;
  std::unordered_set<std::string> families;
  std::unordered_set<std::string> too_many;
  const auto lies_beyond = [&](const std::string& key) {
    if (too_many.empty()) return false;
    for (std::string above = parent_of(key); !above.empty(); above = parent_of(above))
      if (too_many.contains(above)) return true;
    return false;
  };
  for (const FamilySide branch : ordered) {
    const std::string& family = branch->second.lineage.family;
    const bool over = !families.contains(family) && static_cast<int>(families.size()) >= _scene.limits.families;
    if (over || lies_beyond(branch->first)) {
      too_many.insert(branch->first);
      continue;
    }
    kept.push_back(branch);
    families.insert(family);
  }
  std::sort(kept.begin(), kept.end(), [](FamilySide a, FamilySide b) { return a->first < b->first; });
  return kept;
}

std::vector<FamilyTree::Unplaced> FamilyTree::unplaced() const {
  std::vector<Unplaced> found;
  for (const FamilySide branch : kept_branches()) {
    if (!branch->second.outcome || _pruning.arrival(branch->first) != nullptr) continue;
    for (const ArrivalRecord& arrival : branch->second.outcome->arrival)
      if (!arrival.beneath.empty()) found.push_back({branch->first, &arrival});
  }
  return found;
}

void FamilyTree::place(const std::string& branch, const std::string& family, int side, double arclength) {
  const auto host = std::find_if(_branches.begin(), _branches.end(), [&](const auto& entry) {
    const Lineage& lineage = entry.second.lineage;
    return lineage.family == family && lineage.side == side && !_pruning.is_dropped(entry.first);
  });
  core::require(host != _branches.end(), "a crossing lies on a family that stays");
  const EndedBranch& own = _branches.at(branch);
  LocateOutcome crossing = own.outcome->arrival.front().beneath.front().crossing;
  crossing.lineage = host->second.lineage;
  crossing.arclength = arclength;
  // Branches that come along other directions meet the same one.
  const auto same = std::find_if(_crossings.begin(), _crossings.end(), [&](const auto& entry) {
    const LocateOutcome& known = entry.second;
    return (known.limited_by & order_limited) != 0 && known.lineage.family == family && known.q == crossing.q &&
           std::abs(known.period / crossing.period - 1.0) < same_period;
  });
  if (same == _crossings.end()) {
    const int number = first_placed + static_cast<int>(_crossings.size());
    crossing.key = event_key(host->first, number, fmt::format("q{}.j{}", crossing.q, crossing.j));
  } else {
    crossing.key = same->first;
  }
  LocateOutcome& placed = _crossings.try_emplace(crossing.key, crossing).first->second;
  LeavingRecord& leaving = placed.leaving.emplace_back();
  leaving.key = fmt::format("{}/{}", crossing.key, placed.leaving.size() - 1);
  leaving.isotropy = own.isotropy;
  count(_pruning.add_meetings({{branch, Meeting{crossing.key, {leaving.key, 1}, 0.0}}}));
}

DirectionFate FamilyTree::fate_of(const std::string& branch, const Lineage& lineage) const {
  if (_not_begun.contains(branch)) return DirectionFate::beyond_limits;
  return _limit.has_room({lineage.depth, branch}, lineage.family) ? DirectionFate::unknown
                                                                  : DirectionFate::beyond_families;
}

FamilyTree::Result FamilyTree::resolve() const {
  Result result;
  const std::vector<FamilySide> kept = kept_branches();
  std::vector<Family> families = families_of(kept);
  name_families(families, _crossings, _scene.fixed_points.letters);

  std::unordered_set<std::string> kept_keys;
  for (const FamilySide branch : kept) kept_keys.insert(branch->first);
  const auto on_kept = [&](const std::string& crossing) { return kept_keys.contains(branch_of(crossing)); };
  std::vector<const LocateOutcome*> crossings;
  for (const auto& [key, crossing] : _crossings)
    if (on_kept(key)) crossings.push_back(&crossing);

  const std::map<std::string, int> rows = add_crossings(families, crossings, _units, result);
  add_families(
      families, _crossings, rows, _units, [this](const std::string& key) { return _pruning.arrival(key); }, result);
  add_loci(_loci, _crossings, rows, _units, result);
  result.evidence = evidence_of(
      {_branches, _crossings, _failures, _locus_failures, _undecided, _pruning, _arrivals, kept, rows, _units,
       [this](const std::string& branch, const Lineage& lineage) { return fate_of(branch, lineage); }});
  std::unordered_set<std::string> kept_families;
  for (const Family& family : families) kept_families.insert(family.key);
  std::set<std::string> left_out;
  for (const auto& [key, branch] : _branches)
    if (!kept_families.contains(branch.lineage.family)) left_out.insert(branch.lineage.family);
  result.tables.left_out_keys.assign(left_out.begin(), left_out.end());

  const std::map<std::string, std::string> names = names_by_key(families);
  for (const auto* failures : {&result.evidence.failures, &result.evidence.failed_loci})
    for (const FailureEvidence& failure : *failures)
      result.failures.push_back(fmt::format("{}: {}", names.at(failure.family), failure.reason));
  for (std::string& text : passed_texts(kept, names, _units)) result.remarks.push_back(std::move(text));
  const auto beyond = std::count_if(crossings.begin(), crossings.end(), [this](const LocateOutcome* crossing) {
    return crossing->multiplicity * crossing->period > _scene.limits.period;
  });
  if (beyond > 0)
    result.remarks.push_back(
        fmt::format("{} crossings lead to orbits beyond limits.period: nothing was started there", beyond));
  for (const FamilySide branch : kept)
    if (branch->second.outcome)
      for (const std::string& remark : branch->second.outcome->remarks)
        result.remarks.push_back(fmt::format("{}: {}", names.at(branch->second.lineage.family), remark));
  for (const std::string& key : _pruning.disputed())
    if (kept_keys.contains(key))
      result.remarks.push_back(fmt::format(
          "{}: another branch arrives where this one starts, yet it is kept: arrivals contradict each other "
          "about which branches are the same, so a curve may be recorded twice",
          names.at(_branches.at(key).lineage.family)));
  result.names = names;
  return result;
}

}  // namespace orbweaver::survey
