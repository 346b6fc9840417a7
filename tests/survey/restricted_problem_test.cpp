// The planar circular restricted three-body problem: what a tree says may not hang on the first step, on the tolerance
// or on which of two mirror images is looked at.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"
#include "survey/long_family.hpp"

namespace restricted_problem_test {
namespace {

using namespace orbweaver;

// Henrard 1973 and Deprit and Henrard 1968 have the short-period family of L4 end on a branch of L3's family.
TEST(RestrictedProblem, ShortFamiliesEndOnThatOfL3) {
  constexpr double branch_point = 6.281648688;
  const core::Communicator comm;
  for (const std::string first : {"0.0017", "0.0052", "0.0087", "0.0122", "0.0175"}) {
    SCOPED_TRACE(first);
    const scene::Scene scene =
        scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
                    {"continuation.start=" + first, "starts.fixed_points.grid=[[-1, 0.499], [-0.866, 0, 0.866]]",
                     "starts.fixed_points.names={[-1.0004166666, 0]: [L3], [0.499, 0.8660254038]: [Long-4, L4], "
                     "[0.499, -0.8660254038]: [Long-5, L5]}",
                     "starts.fixed_points.letters={}", "starts.sweep.period=[6.2, 6.5]", "starts.sweep.step=0.01",
                     "survey.depth=1", "survey.subharmonics=1", "limits.period=8"});
    const survey::Summary summary = test::run(comm, scene, "short");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    ASSERT_EQ(summary.families.size(), 3U);
    const test::Atlas atlas(summary.atlas);
    const auto crossing = atlas.crossing("L3", "branch-point", branch_point);
    ASSERT_TRUE(crossing.has_value());
    EXPECT_NEAR(atlas.crossings().reals("period")[*crossing], branch_point, 1e-9);
    EXPECT_EQ(atlas.crossings().rows(), 1U);
    for (const std::string family : {"L4", "L5"})
      EXPECT_NE(atlas.end_of(family).find("joined L3 at T = 6.28164868"), std::string::npos) << atlas.end_of(family);
  }
}

// All tolerances and first steps: long_family_matrix_test.cpp.
TEST(RestrictedProblem, LongFamilyOfL5EndsAtItsResonance) {
  const core::Communicator comm;
  test::expect_long_family_to_end(comm, {.y = "-0.866"});
}

// Earth and Moon, at T = 25.29431: beside the short-period family gone around four times an index is 2 to 1e-8 without
// a crossing. One of the two mirror images with these steps had one there.
TEST(RestrictedProblem, MirrorImagesHaveTheSameCrossingsWhereTheyEnd) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_earth_moon.yaml",
                                         {"starts.sweep.period=[20, 22]", "continuation.step=0.03", "limits.steps=300",
                                          "survey.depth=0", "survey.subharmonics=1"});
  const survey::Summary summary = test::run(comm, scene, "mirror");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 2U);
  const test::Atlas atlas(summary.atlas);
  for (const std::string family : {"Long-4", "Long-5"}) {
    EXPECT_FALSE(atlas.crossing(family, "branch-point", 25.2943).has_value()) << family;
    EXPECT_NE(atlas.end_of(family).find("4 times around"), std::string::npos) << atlas.end_of(family);
  }
}

// The short-period families are not looked at for 13 turns: the crossings are those of the branches that end there.
TEST(RestrictedProblem, CrossingsOfHigherOrderLieOnTheirFamilies) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
                                         {"starts.fixed_points.grid=[[0.499], [-0.866, 0.866]]",
                                          "starts.sweep.period=[6.2, 80]", "starts.sweep.step=0.1", "survey.depth=0"});
  const survey::Summary summary = test::run(comm, scene, "higher");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  const archive::Table& crossings = atlas.crossings();
  for (const std::string place : {"4", "5"}) {
    const auto row = atlas.crossing("Short-" + place, "subharmonic", 6.289847916);
    ASSERT_TRUE(row.has_value());
    EXPECT_EQ(crossings.integers("multiplicity")[*row], 13);
    EXPECT_EQ(crossings.integers("sector_q")[*row], 13);
    EXPECT_NEAR(crossings.reals("period")[*row], 6.289847916, 1e-9);
    EXPECT_NEAR(crossings.reals("energy")[*row], -1.234482545, 1e-9);
    // Between the family's orbits that the energy puts it between.
    const std::vector<double> arclengths = atlas.column("arclength", "Short-" + place);
    const std::vector<double> energies = atlas.column("energy", "Short-" + place);
    const auto at = std::upper_bound(arclengths.begin(), arclengths.end(), crossings.reals("arclength")[*row]);
    const auto after = static_cast<std::size_t>(at - arclengths.begin());
    ASSERT_GT(after, 0U);
    ASSERT_LT(after, arclengths.size());
    EXPECT_LT((energies[after] + 1.234482545) * (energies[after - 1] + 1.234482545), 0.0);
    EXPECT_NE(atlas.end_of("Long-" + place).find("joined Short-" + place + " at T = 81.76802"), std::string::npos)
        << atlas.end_of("Long-" + place);
    EXPECT_EQ(atlas.families().integers("end_crossing")[atlas.row_of("Long-" + place)],
              static_cast<std::int64_t>(*row));
  }
}

// Where the long-period family ends rounding hides what of its orbits does not repeat 13 times a period, and decides
// where its branch gives up: the shipped scene's is 1.24 from the crossing. The crossing beneath the last orbit tells
// that it is the right one; of orbits far from there it does not.
TEST(RestrictedProblem, EndsBeforeTheirResonanceAreVerified) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
                                         {"starts.fixed_points.grid=[[0.499], [0.866]]",
                                          "starts.sweep.period=[6.2, 80]", "starts.sweep.step=0.1", "survey.depth=0"});
  const survey::Summary summary = test::run(comm, scene, "ends");
  const auto is_refused = [&](double energy) {  // the end, where the family's last orbit is the one at that energy
    const auto folder = test::fresh_folder(fmt::format("cut{}", comm.size()), comm.get());
    if (comm.is_root()) {
      const test::Atlas atlas(summary.atlas);
      const std::string cut = test::key_of(static_cast<std::int64_t>(atlas.row_of("Long-4")));
      archive::Records records = test::records_of(atlas);
      std::erase_if(records.orbits, [&](const auto& o) { return o.family_key == cut && o.energy > energy; });
      for (std::size_t row = 0; row < records.families.size(); ++row) {
        records.families[row].end_family_key = test::key_of(atlas.families().integers("end_family")[row]);
        records.families[row].end_crossing = static_cast<int>(atlas.families().integers("end_crossing")[row]);
      }
      for (std::size_t row = 0; row < records.crossings.size(); ++row) {
        const auto state = atlas.crossings().reals("state").begin() + static_cast<std::ptrdiff_t>(4 * row);
        records.crossings[row].state.assign(state, state + 4);
        records.crossings[row].residual = atlas.crossings().reals("residual")[row];
        records.crossings[row].test_value = atlas.crossings().reals("test_value")[row];
      }
      test::write_sample_atlas(folder, atlas.header(), records);
    }
    MPI_Barrier(comm.get());
    const survey::Verification found = survey::verify(comm, folder / "atlas.h5");
    return core::agreed(comm.get(), std::any_of(found.objections.begin(), found.objections.end(),
                                                [](const auto& o) { return o.column == "end_crossing"; }));
  };
  // Some of the last orbits, of which rounding decides on which side of an index of 2 they are.
  const std::vector<double> near{-1.252, -1.255, -1.258, -1.262, -1.265};
  EXPECT_FALSE(std::all_of(near.begin(), near.end(), is_refused));
  EXPECT_TRUE(is_refused(-1.32)) << "what does not repeat is most of the orbit";
}

// No reversor maps these orbits to themselves, so nothing but a search tells in which directions families leave; at a
// tripling they move along the short-period family as fast as away from it.
TEST(RestrictedProblem, FamiliesAreBornAtTriplingsWithoutReversor) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_earth_moon.yaml",
                                         {"starts.fixed_points.grid=[[0.488], [0.866]]", "starts.sweep.period=[6, 7]",
                                          "survey.depth=1", "survey.subharmonics=3"});
  const survey::Summary summary = test::run(comm, scene, "tripling");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 2U);
  const test::Atlas atlas(summary.atlas);
  const std::string end = atlas.end_of("SfT3");
  EXPECT_NE(end.find("forwards: joined Short-4 at T = 19.1077714"), std::string::npos) << end;
  EXPECT_NE(end.find("backwards: joined Short-4 at T = 19.1077714"), std::string::npos) << end;
}

/// The Lyapunov family of the Earth and Moon's L2, which runs into the Moon.
scene::Scene second_family(const std::vector<std::string>& more) {
  std::vector<std::string> overrides{
      "starts.fixed_points.grid=[[1.156], [0]]", "starts.fixed_points.names={[1.1556821654, 0]: [L2]}",
      "starts.fixed_points.letters={}", "starts.sweep.period=[3, 3.6]", "survey.depth=0"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_earth_moon.yaml", overrides);
}

TEST(RestrictedProblem, AFamilyEndsAtTheLimitOfAGuard) {
  // Hit from other first steps too (tests/continuation/guards_test.cpp).
  constexpr double energy = -1.450664;
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, second_family({"limits.guards={r2: 0.0045}"}), "guard");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  EXPECT_EQ(atlas.end_of("L2"), "guard limit (r2 = 0.0045)");
  EXPECT_NEAR(atlas.column("energy", "L2").back(), energy, 1e-6);
}

TEST(RestrictedProblem, ALowerLimitOfAGuardGoesOnFromTheFamilysEnd) {
  const core::Communicator comm;
  const scene::Scene low = second_family({"limits.guards={r2: 0.0045}"});
  const scene::Scene high = second_family({"limits.guards={r2: 0.03}"});
  const auto system = systems::make_system(low.system.name, low.system.parameters, low.system.effects);
  const auto folder = test::fresh_folder("widened" + std::to_string(comm.size()), comm.get());
  (void)survey::run_survey(comm, high, system, folder, {});
  survey::RunOptions resumed;
  resumed.resume = true;
  const survey::Summary widened = survey::run_survey(comm, low, system, folder, resumed);
  const survey::Summary whole = test::run(comm, low, "whole");
  if (!comm.is_root()) return;
  const test::Atlas a(widened.atlas);
  const test::Atlas b(whole.atlas);
  EXPECT_EQ(a.end_of("L2"), "guard limit (r2 = 0.0045)");
  for (const char* column : {"period", "energy", "arclength"})
    EXPECT_EQ(a.column(column, "L2"), b.column(column, "L2"));
}

TEST(RestrictedProblem, AFamilyThatCollidesSaysWithWhat) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, second_family({"continuation.cutoff=[8, 100]"}), "collision");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_EQ(test::Atlas(summary.atlas).end_of("L2").find("collision with the smaller body (r2 = 0.0"), 0U);
}

}  // namespace
}  // namespace restricted_problem_test
