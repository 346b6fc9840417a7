// Wells with the symmetry of a triangle: along the axis both indices are equal.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/well_in_space.hpp"
#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace double_indices_test {
namespace {

using namespace orbweaver;

std::vector<std::string> with(std::vector<std::string> settings, const std::string& one) {
  if (!one.empty()) settings.push_back(one);
  return settings;
}

test::Atlas survey_of(const std::map<std::string, double>& coefficients, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"survey.subharmonics=2"};
  all.insert(all.end(), settings.begin(), settings.end());
  return test::survey_of(test::well_in_space<test::WellInSpace<false, test::InSpace::triangle>>(coefficients), all);
}

// Of the family along x the index of y'' = -(1 + 2 b x + 2 g x^2) y passes 2 from E = 0.29765 to 0.31213: with both
// pairs at once, so that no function changes its sign, and within one of the program's own steps.
TEST(DoubleIndices, PassTogether) {
  const double a = 0.4;
  const double b = 0.2;
  const double g = 0.05;
  const std::map<std::string, double> well{{"c200", 0.245}, {"c020", 0.5}, {"c002", 0.5}, {"c012", a}, {"c030", -a / 3},
                                           {"c120", b},     {"c102", b},   {"c220", g},   {"c202", g}, {"c400", 0.25}};
  const std::vector<std::string> settings{"survey.depth=0", "limits.period=12", "limits.energy=[0, 0.5]"};
  const test::Atlas atlas = survey_of(well, settings);
  std::vector<double> energies;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
    if (atlas.crossings().integers("kernel_dimension")[row] != 2) continue;
    EXPECT_EQ(atlas.crossings().texts("kind")[row], "branch-point");
    EXPECT_EQ(atlas.crossings().integers("family")[row], 0);
    energies.push_back(atlas.crossings().reals("energy")[row]);
  }
  std::sort(energies.begin(), energies.end());
  ASSERT_EQ(energies.size(), 2U);
  EXPECT_NEAR(energies[0], 0.297654411, 1e-9);
  EXPECT_NEAR(energies[1], 0.3121337, 1e-8);
  for (const std::string other : {"continuation.step=0.1", "continuation.step=0.03", "continuation.start=0.02"}) {
    SCOPED_TRACE(other);
    test::expect_same_tree(atlas, survey_of(well, with(settings, other)));
  }
}

// A ring of three oscillators, in its modes. Where rounding left both indices real, the planes of the two pairs were
// compared from orbit to orbit, which are rounding's: steps were halved until none was left.
TEST(DoubleIndices, HoldNoFamilyUp) {
  const double k = 0.1;
  const double nonlinear = -1.0 / 24.0;  // of each oscillator, x^4
  const std::map<std::string, double> ring{{"c200", 0.5},
                                           {"c020", 0.5 + 1.5 * k},
                                           {"c002", 0.5 + 1.5 * k},
                                           {"c400", nonlinear / 3.0},
                                           {"c220", 2.0 * nonlinear},
                                           {"c202", 2.0 * nonlinear},
                                           {"c130", 2.0 * std::sqrt(2.0) / 3.0 * nonlinear},
                                           {"c112", -2.0 * std::sqrt(2.0) * nonlinear},
                                           {"c040", 0.5 * nonlinear},
                                           {"c022", nonlinear},
                                           {"c004", 0.5 * nonlinear}};
  for (const std::string start : {"", "continuation.start=0.003", "continuation.start=0.05"}) {
    SCOPED_TRACE(start);
    const test::Atlas atlas =
        survey_of(ring, with({"survey.depth=0", "limits.period=16", "limits.energy=[0, 1]", "limits.steps=60"}, start));
    for (const std::string& end : atlas.families().texts("end_reason"))
      EXPECT_TRUE(end.starts_with("energy limit")) << end;
  }
}

}  // namespace
}  // namespace double_indices_test
