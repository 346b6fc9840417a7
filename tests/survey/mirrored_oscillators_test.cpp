// Particles in wells in space that are mirrored in one coordinate or two, with frequencies near a resonance.
#include <string>

#include <gtest/gtest.h>

#include "support/well_in_space.hpp"
#include "survey/surveyed_well.hpp"

namespace {

using namespace orbweaver;

// Two frequencies nearly alike: families cross one another at two branch points next to one another. Both branches
// leave mode 1 so that its orbits beside the crossings are the nearest ones to theirs, and have all their symmetries.
// They passed for orbits of the branches, and the survey contradicted itself.
TEST(MirroredOscillators, OrbitsOfMoreSymmetryAreNotTheBranches) {
  const auto system = test::well_in_space<test::WellInSpace<false, test::InSpace::mirror>>({{"c200", 0.4947},
                                                                                            {"c020", 0.5162},
                                                                                            {"c002", 2.047},
                                                                                            {"c012", 0.2684},
                                                                                            {"c030", 0.2019},
                                                                                            {"c102", 0.1226},
                                                                                            {"c120", 0.2374},
                                                                                            {"c210", 0.2957},
                                                                                            {"c300", -0.09662},
                                                                                            {"c004", 0.2371},
                                                                                            {"c022", 0.3479},
                                                                                            {"c040", 0.3598},
                                                                                            {"c202", 0.325},
                                                                                            {"c220", 0.1511},
                                                                                            {"c400", 0.1716}});
  const test::Atlas atlas = test::survey_of(
      system, {"survey.depth=1", "survey.subharmonics=3", "limits.period=16", "limits.energy=[-0.5, 0.177]"}, true);
  for (const std::string name : {"Equilibrium 1, mode 1 B1", "Equilibrium 1, mode 1 B2"})
    EXPECT_GT(atlas.column("period", name).size(), 1U) << name;
}

// Mirrored in y and z, which is not declared: an index of mode 3 comes to -2 and turns, and of what goes twice around
// from there two families are symmetric under time reversal, and a third lies between them. Only the two were found,
// and the third, which comes from mode 1, ended along none of the directions. With short steps the place was found
// twice.
TEST(MirroredOscillators, FamiliesBetweenThoseThatSymmetrySinglesOutAreFound) {
  const auto system = test::well_in_space<test::WellInSpace<true, test::InSpace::nothing>>({{"c200", 0.5161},
                                                                                            {"c020", 1.038},
                                                                                            {"c002", 2.049},
                                                                                            {"c300", -0.2944},
                                                                                            {"c120", -0.1188},
                                                                                            {"c102", -0.1818},
                                                                                            {"c400", 0.1237},
                                                                                            {"c040", 0.2292},
                                                                                            {"c004", 0.2274},
                                                                                            {"c220", 0.1294},
                                                                                            {"c202", 0.2164},
                                                                                            {"c022", 0.3429}});
  for (const std::string setting : {"continuation.step=0.03", "continuation.start=0.002"}) {
    SCOPED_TRACE(setting);
    const test::Atlas atlas = test::survey_of(system, {"survey.depth=1", "survey.subharmonics=3", "limits.period=16",
                                                       "limits.energy=[-0.5, 0.259]", setting});
    EXPECT_EQ(atlas.families().rows(), 5U);
    EXPECT_EQ(atlas.crossings().rows(), 4U);
  }
}

}  // namespace
