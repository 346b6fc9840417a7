#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::test {

struct TreeOptions {
  std::size_t failures = 0;  ///< families that may end in failure
  int base_families = -1;    ///< families without a parent that there must be; -1: any number
};

/// What is wrong with the tree of families, one sentence each (empty: nothing). Looked at are the references between
/// families and crossings, multiplicities against the crossings' and against periods (the orbit next to the crossing:
/// 5 %), energies at a birth (5 % of the archive's range), names, steps, end reasons, places of crossings, and how well
/// each crossing of the sector j/q was located: with k its test value and e the larger stability error of the two
/// orbits around it, |k - 2 cos(2 pi j/q)| and the residual are at most max(1e-9, e, |dk/ds| 1e-10).
[[nodiscard]] std::vector<std::string> tree_problems(const archive::Archive& atlas, const TreeOptions& options);

}  // namespace orbweaver::test
