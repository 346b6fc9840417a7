#pragma once

#include <compare>
#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// One side of a direction in which a family leaves its crossing. The branch that runs there starts along it; another
/// that arrives there is the same curve, run backwards.
struct Side {
  std::string family;
  int side = 1;
  friend auto operator<=>(const Side&, const Side&) = default;
};
[[nodiscard]] inline Side side_of(const Lineage& lineage) { return {lineage.family, lineage.side}; }

/// A place where a branch may have arrived: a crossing, and the direction along which it came.
struct Meeting {
  std::string crossing;
  Side along;
  double away = 0.0;  ///< of the orbit before, from the direction, in parts of its distance from the crossing
};

/// Who lies on whom, and who may have arrived where: all that pruning looks at. Branches have numbers in the order in
/// which they came to be known, which decides nothing; `comes_first` does.
class BranchGraph {
 public:
  using Number = int;
  static constexpr Number none = -1;

  /// A meeting with the branch that its crossing lies on, and its side, by number.
  struct Candidate {
    Meeting meeting;
    Number on = none;
    Number side = none;
  };
  struct Branch {
    std::string key;
    int depth = 0;
    Number parent = none;
    std::vector<Number> children;
    Number side = none;                 ///< along which it starts; none until the branch has ended
    std::vector<Candidate> candidates;  ///< nearest first, equally near ones by key
    std::vector<Number> visitors;       ///< branches with a candidate on this one
    std::vector<Number> passes;         ///< sides of base families whose first orbit lies on it
  };

  /// A branch has ended. Throws MisuseError if it had before.
  Number add_ended(const std::string& key, const Lineage& lineage);
  /// Branch `key`, which has ended, may have arrived there.
  Number add_candidate(const std::string& key, const Meeting& meeting);

  /// Branch `key`, which has ended, has passed the first orbit of a base family.
  void add_passed(const std::string& key, const std::string& family);

  [[nodiscard]] Number count() const { return static_cast<Number>(_branches.size()); }
  [[nodiscard]] Number side_count() const { return static_cast<Number>(_starters.size()); }
  [[nodiscard]] const Branch& operator[](Number n) const { return _branches[static_cast<std::size_t>(n)]; }
  /// None if neither it nor anything on it is known.
  [[nodiscard]] Number find(const std::string& key) const;
  [[nodiscard]] Number find(const Side& side) const;
  /// Ended branches that start along a side.
  [[nodiscard]] const std::vector<Number>& starters(Number side) const {
    return _starters[static_cast<std::size_t>(side)];
  }
  /// Ended branches that have passed the orbit at which a side begins.
  [[nodiscard]] const std::vector<Number>& passers(Number side) const {
    return _passers[static_cast<std::size_t>(side)];
  }

  /// The order that decides who stays: by depth, then key. Parents come before children.
  [[nodiscard]] bool comes_first(Number a, Number b) const;
  [[nodiscard]] bool comes_first(Number a, const std::string& key) const;
  [[nodiscard]] bool lies_on(Number a, Number b) const;

 private:
  /// Number of the branch, new with all that it lies on if need be.
  Number known(const std::string& key);
  Number known(const Side& side);
  Branch& at(Number n) { return _branches[static_cast<std::size_t>(n)]; }

  std::deque<Branch> _branches;
  std::unordered_map<std::string, Number> _numbers;
  std::map<Side, Number> _sides;
  std::vector<std::vector<Number>> _starters;  // by side
  std::vector<std::vector<Number>> _passers;   // by side
};

}  // namespace orbweaver::survey
