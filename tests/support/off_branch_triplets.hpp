#pragma once

#include <algorithm>
#include <vector>

#include "orbweaver/continuation/off_branch.hpp"

namespace orbweaver::test {

/// The `options.count` smallest of all sectors of an isotropy whose generators are involutions.
inline std::vector<continuation::OffBranchTriplet> off_branch_triplets(const systems::System& system,
                                                                       const loop::Loop& loop,
                                                                       const loop::Isotropy& isotropy,
                                                                       const loop::Tangent& tangent,
                                                                       const spectrum::TripletOptions& options) {
  std::vector<continuation::OffBranchTriplet> all;
  for (unsigned pattern = 0; pattern < (1u << isotropy.size()); ++pattern) {
    std::vector<int> signs;
    for (std::size_t n = 0; n < isotropy.size(); ++n) signs.push_back(((pattern >> n) & 1u) == 0u ? 1 : -1);
    for (auto& t : continuation::sector_triplets(system, loop, isotropy, signs, tangent, options))
      all.push_back(std::move(t));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.singular_value < b.singular_value; });
  if (all.size() > static_cast<std::size_t>(options.count)) all.resize(static_cast<std::size_t>(options.count));
  return all;
}

}  // namespace orbweaver::test
