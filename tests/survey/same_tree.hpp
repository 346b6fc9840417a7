#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/tree/family_end.hpp"
#include "survey/atlas.hpp"

namespace orbweaver::test {

/// How far periods and energies of crossings may be apart, relative to the period and to an energy of the system + |E|.
constexpr double same_crossing = 1e-10;

struct ListedCrossing {
  std::string what;  // kind and sector
  double period = 0.0;
  double energy = 0.0;  // of families along a parameter, that
};

/// What a tree says of a family, but for orbits.
struct ListedFamily {
  std::string parent;
  double born_at = 0.0;
  std::string isotropy;
  std::int64_t multiplicity = 1;
  std::multiset<std::string> ends;
  bool grows = false;  ///< of orbits on both sides of a crossing: whether T is longer at the end of the side that is +
  std::vector<ListedCrossing> crossings;  // by period
};

inline std::map<std::string, ListedFamily> listed(const Atlas& atlas, double time, double energy) {
  std::map<std::string, ListedFamily> out;
  const auto& names = atlas.families().texts("name");
  for (std::size_t row = 0; row < names.size(); ++row) {
    ListedFamily& family = out[names[row]];
    const auto crossing = atlas.families().integers("crossing")[row];
    if (crossing >= 0) {
      family.parent = names[static_cast<std::size_t>(atlas.families().integers("parent")[row])];
      family.born_at = atlas.crossings().reals("period")[static_cast<std::size_t>(crossing)] / time;
    }
    family.isotropy = atlas.families().texts("isotropy")[row];
    family.multiplicity = atlas.families().integers("multiplicity")[row];
    for (const survey::EndKind end : survey::ends_in(atlas.families().texts("end_reason")[row]))
      family.ends.insert(std::string(survey::name_of(end)));
    const auto begin = static_cast<std::size_t>(atlas.families().integers("first_orbit")[row]);
    const std::size_t end = begin + static_cast<std::size_t>(atlas.families().integers("orbit_count")[row]);
    const auto& periods = atlas.orbits().reals("period");
    if (atlas.orbits().integers("step")[begin] < 0) family.grows = periods[end - 1] > periods[begin];
    const auto joined = atlas.families().integers("end_family")[row];
    if (joined >= 0) family.ends.insert("at " + names[static_cast<std::size_t>(joined)]);
  }
  const auto level = [&](std::size_t row) {
    const double value = atlas.crossings().reals("energy")[row] / energy;
    return std::isnan(value) ? atlas.crossings().reals("parameter")[row] : value;
  };
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    out[names[static_cast<std::size_t>(atlas.crossings().integers("family")[row])]].crossings.push_back(
        {fmt::format("{} {}/{} m {} kernel {}", atlas.crossings().texts("kind")[row],
                     atlas.crossings().integers("sector_j")[row], atlas.crossings().integers("sector_q")[row],
                     atlas.crossings().integers("multiplicity")[row],
                     atlas.crossings().integers("kernel_dimension")[row]),
         atlas.crossings().reals("period")[row] / time, level(row)});
  for (auto& [name, family] : out)
    std::sort(family.crossings.begin(), family.crossings.end(), [](const ListedCrossing& a, const ListedCrossing& b) {
      return std::tie(a.what, a.period, a.energy) < std::tie(b.what, b.period, b.energy);
    });
  return out;
}

/// The same families by the same names, born at the same places, with the same crossings and ends. `time`, `energy`: of
/// the units of `b` in those of `a`. `size`: an energy of the system, in the units of `a`; 0 is any other.
inline void expect_same_tree(const Atlas& a, const Atlas& b, double time = 1.0, double energy = 1.0,
                             double size = 1.0) {
  const auto first = listed(a, 1.0, 1.0);
  const auto second = listed(b, time, energy);
  for (const auto& [name, family] : second) EXPECT_TRUE(first.contains(name)) << name << " is in the second only";
  for (const auto& [name, family] : first) {
    SCOPED_TRACE(name);
    const auto other = second.find(name);
    if (other == second.end()) {
      ADD_FAILURE() << "in the first only";
      continue;
    }
    EXPECT_EQ(other->second.parent, family.parent);
    EXPECT_NEAR(other->second.born_at, family.born_at, same_crossing * family.born_at);
    EXPECT_EQ(other->second.isotropy, family.isotropy);
    EXPECT_EQ(other->second.multiplicity, family.multiplicity);
    EXPECT_EQ(other->second.ends, family.ends);
    EXPECT_EQ(other->second.grows, family.grows);
    EXPECT_EQ(other->second.crossings.size(), family.crossings.size());
    for (std::size_t n = 0; n < std::min(family.crossings.size(), other->second.crossings.size()); ++n) {
      const ListedCrossing& x = family.crossings[n];
      const ListedCrossing& y = other->second.crossings[n];
      EXPECT_EQ(y.what, x.what) << x.period;
      EXPECT_NEAR(y.period, x.period, same_crossing * x.period) << x.what;
      EXPECT_NEAR(y.energy, x.energy, same_crossing * (size + std::abs(x.energy))) << x.what << " T = " << x.period;
    }
  }
}

}  // namespace orbweaver::test
