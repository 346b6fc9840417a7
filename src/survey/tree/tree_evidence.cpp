#include "tree_evidence.hpp"

#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "arrivals.hpp"
#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

namespace {

class Gatherer {
 public:
  explicit Gatherer(const TreeSources& tree) : _tree(tree) {
    for (const FamilySide branch : tree.kept) {
      _kept.insert(branch->first);
      if (const Meeting* meeting = tree.pruning.arrival(branch->first)) _arrived.insert(meeting->along);
      const EndedBranch& ended = branch->second;
      if (ended.outcome && ended.outcome->end.reason == continuation::EndReason::closed_loop)
        _arrived.insert({ended.lineage.family, -ended.lineage.side});  // back at the crossing, from the other side
    }
  }

  TreeEvidence all() const {
    TreeEvidence evidence;
    for (const auto& [key, row] : _tree.crossing_rows) evidence.crossings.push_back(of(_tree.crossings.at(key), row));
    for (const FamilySide branch : _tree.kept) {
      evidence.ends.push_back(of(*branch));
      if (branch->second.failed) evidence.failures.push_back({branch->second.lineage.family, branch->second.reason});
      if (!branch->second.outcome) continue;
      for (const std::string& passed : branch->second.outcome->unlocated)
        evidence.undecided.push_back({branch->second.lineage.family, passed});
    }
    add_tasks("", _tree.failed_locations, evidence.failures);
    add_tasks("locus from ", _tree.failed_loci, evidence.failed_loci);
    add_tasks("", _tree.undecided_events, evidence.undecided);
    for (const std::string& key : _tree.pruning.disputed())
      if (_kept.contains(key)) evidence.disputed.push_back(_tree.branches.at(key).lineage.family);
    return evidence;
  }

 private:
  void add_tasks(std::string_view kind, const std::map<std::string, std::string>& reasons,
                 std::vector<FailureEvidence>& to) const {
    for (const auto& [key, reason] : reasons)
      if (_kept.contains(branch_of(key)))
        to.push_back({_tree.branches.at(branch_of(key)).lineage.family,
                      fmt::format("{}{}: {}", kind, event_text(key.substr(0, key.find(':'))), reason)});
  }

  /// "period-doubling T 8.44293", or "event 3" of one that was not located: on its family, whose name stands before it.
  [[nodiscard]] std::string event_text(const std::string& key) const {
    const auto crossing = _tree.crossings.find(key);
    if (crossing == _tree.crossings.end() || !crossing->second.kind)
      return fmt::format("event {}", event_number(key, branch_of(key)) + 1);
    return fmt::format("{} T {:.6g}", archive::name_of(*crossing->second.kind),
                       crossing->second.period * _tree.units.time);
  }

  [[nodiscard]] DirectionFate fate_of(const LocateOutcome& crossing, const LeavingRecord& leaving, int side) const {
    const std::string key = branch_key(leaving, side);
    const auto branch = _tree.branches.find(key);
    if (_arrived.contains({leaving.key, side})) return DirectionFate::arrived;
    if (leaving.hidden) return DirectionFate::hidden;
    if (branch == _tree.branches.end())
      return _tree.fate_of_unknown(
          key, {leaving.key, crossing.key, crossing.lineage.depth + 1, crossing.multiplicity, side});
    if (_kept.contains(key)) return branch->second.failed ? DirectionFate::failed : DirectionFate::followed;
    return _tree.pruning.is_dropped(key) ? DirectionFate::unknown : DirectionFate::beyond_families;
  }

  [[nodiscard]] CrossingEvidence of(const LocateOutcome& crossing, int row) const {
    CrossingEvidence evidence{row,
                              crossing.q,
                              crossing.kernel_dimension,
                              crossing.limited_by,
                              _tree.failed_locations.contains(crossing.key),
                              crossing.undecided,
                              static_cast<int>(crossing.leaving.size()),
                              {}};
    for (const LeavingRecord& leaving : crossing.leaving)
      for (const int side : {1, -1})
        if (side > 0 || leaving.both_sides) evidence.sides.push_back(fate_of(crossing, leaving, side));
    return evidence;
  }

  [[nodiscard]] EndEvidence of(const EndedBranches::value_type& entry) const {
    const auto& [key, branch] = entry;
    EndEvidence evidence;
    evidence.family = branch.lineage.family;
    evidence.side = branch.lineage.side;
    evidence.failed = branch.failed;
    if (!branch.outcome) return evidence;
    evidence.end = branch.outcome->end;
    if (branch.outcome->arrival.empty()) return evidence;
    const ArrivalRecord& arrival = branch.outcome->arrival.front();
    evidence.met = true;
    evidence.period = arrival.period * _tree.units.time;
    evidence.level = arrival.level * _tree.units.level();
    evidence.is_short = arrival.is_short;
    if (const Meeting* meeting = _tree.pruning.arrival(key)) {
      evidence.joined = true;
      const auto row = _tree.crossing_rows.find(meeting->crossing);
      if (row != _tree.crossing_rows.end()) evidence.crossing = row->second;
      return evidence;
    }
    for (const auto& [place, row] : _tree.crossing_rows)
      if (archive::has_sector(*_tree.crossings.at(place).kind) && within_window(arrival, _tree.crossings.at(place)) &&
          !_tree.arrivals.are_apart(key, place))
        evidence.nearby.push_back(row);
    return evidence;
  }

  const TreeSources& _tree;
  std::unordered_set<std::string> _kept;
  std::set<Side> _arrived;  // by branches that stay
};

}  // namespace

TreeEvidence evidence_of(const TreeSources& tree) { return Gatherer(tree).all(); }

}  // namespace orbweaver::survey
