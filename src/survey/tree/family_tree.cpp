#include "family_tree.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/survey/tasks/keys.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "orbweaver/survey/tree/naming.hpp"

namespace orbweaver::survey {

namespace {

bool lies_on_one_of(const std::string& key, const std::set<std::string>& branches) {
  if (branches.empty()) return false;
  for (std::size_t slash = key.find('/'); slash != std::string::npos; slash = key.find('/', slash + 1))
    if (branches.contains(key.substr(0, slash))) return true;
  return false;
}

/// How far an arrival may be from the crossing that it is compared with, in period and energy.
constexpr double arrival_window = 1e-3;

/// The kind of a family in its name: B, D, T3, ...
std::string letter_of(int multiplicity) {
  if (multiplicity == 1) return "B";
  return multiplicity == 2 ? "D" : fmt::format("T{}", multiplicity);
}

}  // namespace

/// A family with its branches: one, or one a side.
struct FamilyTree::Family {
  std::string key;
  Lineage lineage;
  std::vector<const Branch*> sides;  // + first
  std::string name;
};

void FamilyTree::add(const queue::Task& task, const queue::TaskOutcome& outcome) {
  const TaskKind kind = kind_of(task);
  if (kind == TaskKind::branch) {
    BranchWork work = unpack_branch_work(task.payload);
    Branch& branch = _branches[task.key];
    branch.lineage = std::move(work.lineage);
    branch.name = std::move(work.name);
    branch.isotropy = std::move(work.isotropy);
    branch.failed = outcome.failed;
    branch.reason = outcome.reason;
    if (outcome.payload.empty()) return;
    branch.outcome = unpack_branch_outcome(outcome.payload);
    branch.outcome->before_limit = {};  // a journal has it
  } else if (kind == TaskKind::start && outcome.failed) {
    const BranchWork work = unpack_start_work(task.payload).branch;
    _branches[work.key] = {work.lineage, work.name, work.isotropy, std::nullopt, true, outcome.reason};
  } else if (kind == TaskKind::locate) {
    if (outcome.failed) _failures[place_of(task.key)] = outcome.reason;
    if (outcome.payload.empty()) return;
    LocateOutcome crossing = unpack_locate_outcome(outcome.payload);
    const std::string key = crossing.key;
    if (!crossing.kind) return;
    if (!crossing.leaving.empty()) _leaving.insert({crossing.multiplicity * crossing.period, key});
    _crossings.insert_or_assign(key, std::move(crossing));
  }
}

std::optional<FamilyTree::Meeting> FamilyTree::meeting_of(const Branch& branch, const LocateOutcome& crossing) const {
  const ArrivalRecord& arrival = branch.outcome->arrival.front();
  const double period = crossing.multiplicity * crossing.period;
  if (!(std::abs(arrival.period / period - 1.0) <= arrival_window &&
        std::abs(arrival.energy - crossing.energy) <= arrival_window * (1.0 + std::abs(crossing.energy))))
    return std::nullopt;
  const loop::Loop near = loop_of(arrival.near);
  std::optional<Meeting> best;
  double nearest = 0.4;  // of the distance from the crossing's orbit; other directions are further off
  for (const LeavingRecord& leaving : crossing.leaving) {
    const loop::Loop base = loop_of(leaving.base);
    const double distance = loop::align(_system, near, base).distance;
    const double unit = loop::mean_distance(base, loop::moved(base, leaving.direction, 1.0));
    for (const int side : {1, -1}) {
      if (side < 0 && !leaving.both_sides) continue;
      const loop::Loop expected = loop::moved(base, leaving.direction, side * distance / unit);
      const double away = loop::align(_system, near, expected).distance / distance;
      if (away < nearest) {
        nearest = away;
        best = Meeting{crossing.key, leaving.key, side, away};
      }
    }
  }
  return best;
}

std::optional<FamilyTree::Meeting> FamilyTree::meeting_of(const Branch& branch, const Keys& dropped) const {
  if (!branch.outcome || branch.outcome->arrival.empty()) return std::nullopt;
  std::optional<Meeting> best;
  const double period = branch.outcome->arrival.front().period;
  const auto last = _leaving.upper_bound({period * (1.0 + 2.0 * arrival_window), ""});
  std::set<std::string> near;  // in the order of keys
  for (auto at = _leaving.lower_bound({period * (1.0 - 2.0 * arrival_window), ""}); at != last; ++at)
    near.insert(at->second);
  for (const std::string& key : near) {
    if (lies_on_one_of(key, dropped)) continue;
    const std::pair place(branch.outcome->key, key);
    auto known = _met.find(place);
    if (known == _met.end()) known = _met.emplace(place, meeting_of(branch, _crossings.at(key))).first;
    const std::optional<Meeting>& meeting = known->second;
    if (meeting && (!best || meeting->away < best->away)) best = meeting;
  }
  return best;
}

bool FamilyTree::wanted(const queue::Task& task) const {
  const TaskKind kind = kind_of(task);
  if (kind != TaskKind::branch && kind != TaskKind::start) return true;
  const BranchWork work =
      kind == TaskKind::branch ? unpack_branch_work(task.payload) : unpack_start_work(task.payload).branch;
  if (work.lineage.depth == 0) return true;
  const Keys dropped = dropped_branches();
  if (lies_on_one_of(work.key, dropped)) return false;
  Keys earlier;
  for (const auto& [key, other] : _branches) {
    if (dropped.contains(key) || !(std::tie(other.lineage.depth, key) < std::tie(work.lineage.depth, work.key)))
      continue;
    const std::optional<Meeting> meeting = meeting_of(other, dropped);
    if (meeting && meeting->family == work.lineage.family && meeting->side == work.lineage.side) return false;
    earlier.insert(other.lineage.family);
  }
  return earlier.contains(work.lineage.family) || static_cast<int>(earlier.size()) < _scene.limits.families;
}

std::vector<std::pair<std::string, const FamilyTree::Branch*>> FamilyTree::ordered_branches() const {
  std::vector<std::pair<std::string, const Branch*>> ordered;
  for (const auto& [key, branch] : _branches) ordered.emplace_back(key, &branch);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second->lineage.depth, a.first) < std::tie(b.second->lineage.depth, b.first);
  });
  return ordered;
}

/// One round: who is dropped if crossings on `before` do not count.
FamilyTree::Keys FamilyTree::dropped_without(const Keys& before) const {
  const auto ordered = ordered_branches();
  // Who arrives at a side of a family, by places in the order.
  using Side = std::pair<std::string, int>;
  const auto side_of = [](const Branch& branch) { return Side(branch.lineage.family, branch.lineage.side); };
  std::vector<std::optional<Side>> arrives_at(ordered.size());
  std::map<Side, std::vector<std::size_t>> arrivers;
  for (std::size_t n = 0; n < ordered.size(); ++n)
    if (const std::optional<Meeting> meeting = meeting_of(*ordered[n].second, before)) {
      arrives_at[n] = Side(meeting->family, meeting->side);
      arrivers[*arrives_at[n]].push_back(n);
    }
  const auto covered = [&](std::size_t n, const auto& by) {
    const auto found = arrivers.find(side_of(*ordered[n].second));
    return found != arrivers.end() && std::any_of(found->second.begin(), found->second.end(), by);
  };
  Keys dropped;
  // By branches that come first, and so stay themselves.
  for (std::size_t n = 0; n < ordered.size(); ++n)
    if (covered(n, [&](std::size_t other) { return other < n && !dropped.contains(ordered[other].first); }) ||
        lies_on_one_of(ordered[n].first, dropped))
      dropped.insert(ordered[n].first);
  // By later ones, at whose start the branch does not arrive in turn: it failed on the way.
  const Keys by_earlier = dropped;
  const auto by_later = [&](std::size_t n, std::size_t other) {
    return other > n && !by_earlier.contains(ordered[other].first) &&
           !lies_on(ordered[other].first, ordered[n].first) && arrives_at[n] != side_of(*ordered[other].second);
  };
  for (std::size_t n = 0; n < ordered.size(); ++n)
    if (covered(n, [&](std::size_t other) { return by_later(n, other); }) || lies_on_one_of(ordered[n].first, dropped))
      dropped.insert(ordered[n].first);
  return dropped;
}

FamilyTree::Keys FamilyTree::dropped_branches() const {
  Keys dropped;
  constexpr int most_rounds = 20;
  for (int round = 0; round < most_rounds; ++round) {
    Keys next = dropped_without(dropped);
    if (next == dropped) break;
    dropped = std::move(next);
  }
  return dropped;
}

std::map<std::string, FamilyTree::Branch> FamilyTree::kept_branches(const Keys& dropped) const {
  std::map<std::string, Branch> kept;
  Keys families;
  Keys too_many;
  for (const auto& [key, branch] : ordered_branches()) {
    if (dropped.contains(key)) continue;
    const bool over =
        !families.contains(branch->lineage.family) && static_cast<int>(families.size()) >= _scene.limits.families;
    if (over || lies_on_one_of(key, too_many)) {
      too_many.insert(key);
      continue;
    }
    kept.emplace(key, *branch);
    families.insert(branch->lineage.family);
  }
  return kept;
}

std::vector<FamilyTree::Family> FamilyTree::families_of(const std::map<std::string, Branch>& kept) const {
  std::vector<Family> families;
  for (const int side : {1, -1})
    for (const auto& [key, branch] : kept) {
      if (branch.lineage.side != side) continue;
      const auto known = std::find_if(families.begin(), families.end(),
                                      [&, &b = branch](const Family& f) { return f.key == b.lineage.family; });
      if (known != families.end())
        known->sides.push_back(&branch);
      else
        families.push_back({branch.lineage.family, branch.lineage, {&branch}, branch.name});
    }
  std::sort(families.begin(), families.end(), [](const Family& a, const Family& b) {
    return std::tie(a.lineage.depth, a.key) < std::tie(b.lineage.depth, b.key);
  });
  return families;
}

/// Parents come first, so their names are known.
void FamilyTree::name_all(std::vector<Family>& families) const {
  std::map<std::string, std::string> prefix;
  for (Family& family : families) {
    if (family.lineage.depth == 0) {
      const auto letter = _scene.fixed_points.letters.find(family.name);
      prefix[family.key] = letter != _scene.fixed_points.letters.end() ? letter->second : family.name + " ";
      continue;
    }
    const LocateOutcome& crossing = _crossings.at(family.lineage.crossing);
    // The crossings of this kind on the parent where a family begins, by arclength, and the families born at this one.
    std::set<std::pair<double, std::string>> places;
    std::vector<std::string> born;
    for (const Family& other : families) {
      if (other.lineage.depth == 0) continue;
      const LocateOutcome& place = _crossings.at(other.lineage.crossing);
      if (place.lineage.family != crossing.lineage.family || other.lineage.multiplicity != family.lineage.multiplicity)
        continue;
      places.insert({place.arclength, place.key});
      if (place.key == crossing.key) born.push_back(other.key);
    }
    const std::string letter = letter_of(family.lineage.multiplicity);
    family.name = prefix.at(crossing.lineage.family) + letter;
    if (places.size() > 1) {
      const auto place = places.find({crossing.arclength, crossing.key});
      family.name += fmt::format("{}{}", letter.size() > 1 ? "-" : "", std::distance(places.begin(), place) + 1);
    }
    std::sort(born.begin(), born.end());
    if (born.size() > 1) {
      const auto at = std::find(born.begin(), born.end(), family.key) - born.begin();
      family.name += static_cast<char>('a' + at % 26);
    }
    prefix[family.key] = family.name;
  }
}

void FamilyTree::add_crossings(const std::map<std::string, Branch>& kept, Result& result,
                               std::map<std::string, int>& index) const {
  for (const auto& [key, crossing] : _crossings) {
    if (!kept.contains(branch_of(key))) continue;
    // A fold in energy shows twice: as an extremum and as a zero of the test function of q = 1.
    const bool twice = std::any_of(index.begin(), index.end(), [&, &c = crossing](const auto& other) {
      const LocateOutcome& o = _crossings.at(other.first);
      return is_fold(*c.kind) && o.kind == c.kind && o.lineage.family == c.lineage.family &&
             std::abs(o.arclength - c.arclength) < 1e-4 * (1.0 + std::abs(c.arclength));
    });
    if (twice) continue;
    index[key] = static_cast<int>(result.tables.crossings.size());
    archive::CrossingRecord row;
    row.family_key = crossing.lineage.family;
    row.arclength = crossing.arclength;
    row.period = crossing.period;
    row.energy = crossing.energy;
    row.kind = *crossing.kind;
    row.multiplicity = crossing.multiplicity;
    row.kernel_dimension = crossing.kernel_dimension;
    row.residual = crossing.residual;
    row.state = crossing.state;
    row.sector_j = crossing.j;
    row.sector_q = crossing.q;
    row.fundamental_order = crossing.fundamental_order;
    row.test_value = crossing.test_value;
    row.kernel_residual = crossing.kernel_singular_value;
    result.tables.crossings.push_back(std::move(row));
  }
}

void FamilyTree::add_families(const std::vector<Family>& families, const Keys& dropped,
                              const std::map<std::string, int>& crossing_index, Result& result) const {
  std::map<std::string, std::string> names;
  for (const Family& family : families) names[family.key] = family.name;
  for (const Family& family : families) {
    archive::FamilyRecord record;
    FamilySummary summary;
    record.key = summary.key = family.key;
    record.name = summary.name = family.name;
    record.multiplicity = family.lineage.multiplicity;
    record.isotropy = summary.isotropy = loop::to_text(isotropy_of(family.sides.front()->isotropy, _system));
    if (family.lineage.depth > 0) {
      const LocateOutcome& born = _crossings.at(family.lineage.crossing);
      record.parent_key = born.lineage.family;
      record.crossing = crossing_index.at(born.key);
    }
    summary.depth = family.lineage.depth;
    for (const Branch* side : family.sides) {
      std::string reason = side->outcome ? end_text(*side->outcome) : failure_text(side->reason);
      if (const std::optional<Meeting> meeting = meeting_of(*side, dropped)) {
        const LocateOutcome& met = _crossings.at(meeting->crossing);
        const auto row = crossing_index.find(met.key);
        const auto name = names.find(met.lineage.family);
        if (row != crossing_index.end() && name != names.end()) {
          record.end_family_key = met.lineage.family;
          record.end_crossing = row->second;
          reason = joined_text(name->second, met);
        }
      }
      record.end_reason = record.end_reason.empty() ? reason : both_ends_text(record.end_reason, reason);
      summary.failed = summary.failed || side->failed;
      if (side->failed) result.failures.push_back(fmt::format("{} ({}): {}", family.key, family.name, side->reason));
      if (!side->outcome || side->outcome->orbits == 0) continue;
      const BranchOutcome& o = *side->outcome;
      const bool first = summary.orbits == 0;
      summary.orbits += o.orbits;
      summary.period_from = first ? o.period_from : std::min(summary.period_from, o.period_from);
      summary.period_to = first ? o.period_to : std::max(summary.period_to, o.period_to);
      summary.energy_from = first ? o.energy_from : std::min(summary.energy_from, o.energy_from);
      summary.energy_to = first ? o.energy_to : std::max(summary.energy_to, o.energy_to);
    }
    if (family.sides.size() == 1) {  // of a family with two sides the other one may have been run as well
      if (family.lineage.side < 0) record.last_step = -1;
      if (family.lineage.side > 0) record.first_step = 0;
    }
    record.end_reason = summary.end_reason = limited(record.end_reason);
    result.tables.families.push_back(std::move(record));
    result.families.push_back(std::move(summary));
  }
}

FamilyTree::Result FamilyTree::resolve() const {
  Result result;
  const Keys dropped = dropped_branches();
  const std::map<std::string, Branch> kept = kept_branches(dropped);
  std::vector<Family> families = families_of(kept);
  name_all(families);
  std::map<std::string, int> crossing_index;
  add_crossings(kept, result, crossing_index);
  add_families(families, dropped, crossing_index, result);
  Keys kept_families;
  for (const Family& family : families) kept_families.insert(family.key);
  Keys left_out;
  for (const auto& [key, branch] : _branches)
    if (!kept_families.contains(branch.lineage.family)) left_out.insert(branch.lineage.family);
  result.tables.left_out_keys.assign(left_out.begin(), left_out.end());
  const auto on_kept = [&](const std::string& crossing) { return kept.contains(branch_of(crossing)); };
  for (const auto& [key, reason] : _failures)
    if (on_kept(key)) result.failures.push_back(fmt::format("locate {}: {}", key, reason));
  const auto beyond = std::count_if(_crossings.begin(), _crossings.end(), [&](const auto& entry) {
    return on_kept(entry.first) && entry.second.multiplicity * entry.second.period > _scene.limits.period;
  });
  if (beyond > 0)
    result.remarks.push_back(
        fmt::format("{} crossings lead to orbits beyond limits.period: nothing was started there", beyond));
  for (const auto& [key, branch] : kept)
    if (branch.outcome)
      for (const std::string& remark : branch.outcome->remarks)
        result.remarks.push_back(fmt::format("{}: {}", key, remark));
  return result;
}

}  // namespace orbweaver::survey
