#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "orbweaver/survey/atlas/loop_check.hpp"

namespace orbweaver::report {

using survey::all_invariants;
using survey::AtlasTree;
using survey::CurveFit;
using survey::FamilyEnd;
using survey::Invariant;
using survey::InvariantCurve;
using survey::Invariants;
using survey::LoopAnswer;
using survey::LoopCheck;
using survey::TreeCrossing;
using survey::TreeFamily;

/// The place of a row in an array.
[[nodiscard]] constexpr std::size_t index(int row) { return static_cast<std::size_t>(row); }

/// What two atlases have in common. Rows of families and crossings; -1: nothing.
struct TreeMatch {
  std::vector<int> family_of_a;  ///< row in B of each family of A
  std::vector<int> family_of_b;
  std::vector<int> crossing_of_a;
  std::vector<int> crossing_of_b;
  std::vector<bool> is_born_elsewhere;  ///< families of A that were matched by their orbits alone
};

/// Matches families down from the roots: roots with roots; then, at each crossing that both have, the families born
/// there with one another, by the share of orbits that lie on the other's curve; their loops decide where several share
/// most of them. What is left is matched with anything that shares its orbits, wherever it was born.
[[nodiscard]] TreeMatch match_trees(const AtlasTree& a, const AtlasTree& b, const LoopCheck& loops);

}  // namespace orbweaver::report
