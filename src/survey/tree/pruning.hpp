#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "branch_graph.hpp"
#include "pruning_round.hpp"

namespace orbweaver::survey {

/// Which branches are the same curve as another that stays, from its other end or from an orbit on it, or lie on such a
/// one. A pure function of the branches and their candidates, whatever the order in which they are added; an addition
/// costs what depends on it.
///
/// Crossings on a dropped branch do not count where others arrive, so the rule (PruningRound) is applied to its own
/// result, from `nothing is dropped` on, until that stays as it is. Each round is kept and brought up to date by what
/// changed in the one before. Where one crossing is taken for another, the rule may contradict itself: if A is dropped
/// then B stays, if B stays then A stays. After `free_rounds` a round may therefore only take branches back; such
/// rounds come to an end since a finite set shrinks. What the rule would still drop then is kept and told (`disputed`):
/// a curve that is recorded twice is better than one that is lost.
class Pruning {
 public:
  /// More than the generations of the deepest survey (survey.depth is at most 16): a round passes on to the next one
  /// what has changed for those who arrive at places below.
  static constexpr int free_rounds = 20;

  /// A branch has ended; it may have arrived at these places, and has passed the first orbits of these base families.
  /// Returns the keys of ended branches whose drop changed.
  std::vector<std::string> add_branch(const std::string& key, const Lineage& lineage,
                                      const std::vector<Meeting>& meetings,
                                      const std::vector<std::string>& passed = {});
  /// Branches that have ended may have arrived at these places too.
  std::vector<std::string> add_meetings(const std::vector<std::pair<std::string, Meeting>>& meetings);

  /// Whether a branch that has ended is dropped.
  [[nodiscard]] bool is_dropped(const std::string& key) const;
  /// Whether a branch that has not ended lies on a dropped one, or an earlier one that stays has arrived along its
  /// side or passed the orbit at which it begins.
  [[nodiscard]] bool would_be_dropped(const std::string& key, const Lineage& lineage) const;
  /// Where a branch that has ended arrived; null if nowhere that counts.
  [[nodiscard]] const Meeting* arrival(const std::string& key) const;
  /// Branches that stay although another one arrives along their side, since the rule contradicts itself there.
  [[nodiscard]] std::vector<std::string> disputed() const;
  [[nodiscard]] int rounds() const { return static_cast<int>(_rounds.size()); }

 private:
  using Number = BranchGraph::Number;
  std::vector<std::string> settle(const std::vector<Number>& changed);
  [[nodiscard]] Number ended(const std::string& key) const;

  std::unique_ptr<BranchGraph> _graph = std::make_unique<BranchGraph>();  // rounds point to it
  std::vector<PruningRound> _rounds;                                      // the last has dropped what that before had
  std::vector<bool> _dropped;                                             // ended ones, as was told
};

}  // namespace orbweaver::survey
