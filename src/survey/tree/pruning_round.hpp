#pragma once

#include <set>
#include <vector>

#include "branch_graph.hpp"

namespace orbweaver::survey {

/// One application of the rule of pruning: which branches are dropped if crossings on those dropped `before` do not
/// count.
///
/// Where a branch arrives is then known: at the nearest candidate that counts. A branch is dropped if it lies on a
/// dropped one, if an earlier one that stays by this very clause has passed the orbit at which it begins, or if another
/// arrives along its side: an earlier one that stays by this very clause; else a later one
/// that does, if the branch itself does not arrive at the start of that one (it failed or met a limit on the way) and
/// that one does not lie on it. Each clause asks of earlier branches what the same clause said, and of others what the
/// clause before said; so a pass over those that a change may reach, in the order of the branches, brings everything up
/// to date.
class PruningRound {
 public:
  using Number = BranchGraph::Number;
  /// `only_fewer`: drops no branch that was not dropped before.
  PruningRound(const BranchGraph& graph, bool only_fewer) : _graph(&graph), _only_fewer(only_fewer) {}

  /// `changed` are known since before, and have ended or have new candidates; `flipped` are dropped before and were
  /// not, or the other way round. Returns whose drop has changed.
  std::vector<Number> update(const std::vector<Number>& changed, const std::vector<Number>& flipped);

  [[nodiscard]] bool dropped(Number n) const { return state(n).dropped; }
  /// Dropped by the rule, but not dropped (`only_fewer`).
  [[nodiscard]] bool disputed(Number n) const { return state(n).by_rule && !state(n).dropped; }
  /// Whether this round has dropped just those dropped before.
  [[nodiscard]] bool settled() const { return _differing == 0; }
  /// Where the branch arrived; null if nowhere.
  [[nodiscard]] const BranchGraph::Candidate* arrival(Number n) const;
  /// Branches that arrive along a side.
  [[nodiscard]] const std::vector<Number>& arrivers(Number side) const {
    return _arrivers[static_cast<std::size_t>(side)];
  }

 private:
  struct State {
    bool before = false;
    bool by_earlier = false;
    bool by_rule = false;
    bool dropped = false;
    int candidate = -1;               // at which it arrives
    Number side = BranchGraph::none;  // along which it arrives
  };
  struct Earlier {
    const BranchGraph* graph;
    bool operator()(Number a, Number b) const { return graph->comes_first(a, b); }
  };
  using Pending = std::set<Number, Earlier>;

  [[nodiscard]] State& state(Number n) { return _states[static_cast<std::size_t>(n)]; }
  [[nodiscard]] const State& state(Number n) const { return _states[static_cast<std::size_t>(n)]; }
  [[nodiscard]] bool is_by_earlier(Number n) const;
  [[nodiscard]] bool is_by_rule(Number n) const;
  /// Finds anew where a branch arrives; those whom it concerns become pending.
  void look(Number n, Pending& first, Pending& second);

  const BranchGraph* _graph;
  bool _only_fewer;
  std::vector<State> _states;
  std::vector<std::vector<Number>> _arrivers;  // by side
  int _differing = 0;                          // branches dropped before or dropped, but not both
};

}  // namespace orbweaver::survey
