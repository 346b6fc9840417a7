#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "survey/atlas.hpp"

namespace tree_test {
namespace {

using namespace orbweaver;
using test::Atlas;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<double> wanted_periods{10.0, 17.0};
const std::vector<double> wanted_energies{-2.0, 1.25};

class Tree : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const core::Communicator comm;
    const scene::Scene scene = test::quick_scene({"survey.depth=1", "survey.subharmonics=2", "limits.period=20",
                                                  "events.periods=[10,17]", "events.energies=[-2,1.25]"});
    summary = test::run(comm, scene, "tree");
    if (comm.is_root()) atlas = std::make_unique<Atlas>(summary.atlas);
  }
  static void TearDownTestSuite() { atlas.reset(); }
  void SetUp() override {
    if (!atlas) GTEST_SKIP() << "the archive is looked at on rank 0";
  }

  static void expect_crossing(const std::string& family, const std::string& kind, double period, double tolerance,
                              int kernel, const std::vector<std::string>& born) {
    SCOPED_TRACE(family + ", T = " + std::to_string(period));
    const auto row = atlas->crossing(family, kind, period);
    ASSERT_TRUE(row.has_value());
    EXPECT_NEAR(atlas->crossings().reals("period")[*row], period, tolerance);
    EXPECT_EQ(atlas->crossings().integers("kernel_dimension")[*row], kernel);
    const double index =
        2.0 * std::cos(2.0 * std::numbers::pi * static_cast<double>(atlas->crossings().integers("sector_j")[*row]) /
                       static_cast<double>(atlas->crossings().integers("sector_q")[*row]));
    EXPECT_NEAR(atlas->crossings().reals("test_value")[*row], index, 1e-9);
    EXPECT_LT(std::abs(atlas->crossings().reals("residual")[*row]), 1e-9);
    EXPECT_EQ(atlas->born_at(*row), born);
  }

  static inline survey::Summary summary;
  static inline std::unique_ptr<Atlas> atlas;
};

TEST_F(Tree, HasTheKnownFamilies) {
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_THAT(summary.failed_tasks, IsEmpty());
  EXPECT_THAT(atlas->families().texts("end_reason"), Each(Not(HasSubstr("failure"))));
  EXPECT_THAT(atlas->families().texts("name"), ElementsAre("In-Phase", "ID1a", "ID1b", "ID2a", "ID2b", "IB",
                                                           "Out-Phase", "ODa", "ODb", "OB", "Down-Up", "Up-Down"));
  EXPECT_EQ(static_cast<std::size_t>(summary.crossings), atlas->crossings().rows());
  EXPECT_EQ(static_cast<std::size_t>(summary.orbits), atlas->orbits().rows());
}

// To 1e-9 where the period is known to more digits.
TEST_F(Tree, LocatesCrossingsAndTheirKernels) {
  const std::string doubling = "period-doubling";
  expect_crossing("In-Phase", doubling, 8.442930704977588, 1e-9, 2, {"ID1a", "ID1b"});
  expect_crossing("In-Phase", doubling, 8.6679693272, 1e-8, 2, {});
  expect_crossing("In-Phase", doubling, 9.82502, 1e-5, 2, {"ID2a", "ID2b"});
  expect_crossing("In-Phase", "branch-point", 10.416773281973249, 1e-9, 1, {"IB"});
  expect_crossing("Out-Phase", doubling, 4.059557792801163, 1e-9, 2, {"ODa", "ODb"});
  expect_crossing("Out-Phase", "branch-point", 6.14751, 1e-5, 1, {"OB"});
  for (const char* family : {"Down-Up", "Up-Down"})
    for (const std::int64_t owner : atlas->crossings().integers("family"))
      EXPECT_NE(owner, static_cast<std::int64_t>(atlas->row_of(family))) << family;
}

TEST_F(Tree, TwoKindsOfOrbitsLeaveWhereThePeriodDoubles) {
  for (const std::string parent : {"ID1", "ID2", "OD"}) {
    const std::size_t a = atlas->row_of(parent + "a");
    const std::size_t b = atlas->row_of(parent + "b");
    EXPECT_EQ(atlas->families().texts("isotropy")[a], "R@0");
    EXPECT_EQ(atlas->families().texts("isotropy")[b], "RS@0");
    EXPECT_EQ(atlas->families().integers("multiplicity")[a], 2);
    // Brake orbits rest at s = 0; of the others the first state has positions 0 and velocities.
    const auto& states = atlas->orbits().reals("state");
    const auto row_a = static_cast<std::size_t>(atlas->families().integers("first_orbit")[a]);
    const auto row_b = static_cast<std::size_t>(atlas->families().integers("first_orbit")[b]);
    EXPECT_LT(std::hypot(states[4 * row_a + 2], states[4 * row_a + 3]), 1e-9);
    EXPECT_LT(std::hypot(states[4 * row_b], states[4 * row_b + 1]), 1e-9);
    EXPECT_GT(std::hypot(states[4 * row_b + 2], states[4 * row_b + 3]), 0.1);
  }
}

TEST_F(Tree, ABranchEndsWhereItComesBack) {
  const auto end = atlas->crossing("In-Phase", "period-doubling", 8.667969);
  ASSERT_TRUE(end.has_value());
  for (const std::string name : {"ID1a", "ID1b"}) {
    EXPECT_THAT(atlas->end_of(name), StartsWith("joined In-Phase at T = 17.335938654"));
    EXPECT_EQ(atlas->families().integers("end_family")[atlas->row_of(name)], 0);
    EXPECT_EQ(atlas->families().integers("end_crossing")[atlas->row_of(name)], static_cast<std::int64_t>(*end));
    EXPECT_LT(atlas->column("period", name).back(), 2.0 * atlas->crossings().reals("period")[*end]);
  }
  EXPECT_EQ(atlas->end_of("IB"), "period limit (T = 20)");
  EXPECT_EQ(atlas->column("period", "IB").back(), 20.0);
}

TEST_F(Tree, RequestedOrbitsAreRows) {
  int at_period = 0;
  int at_energy = 0;
  for (const std::string& name : atlas->families().texts("name")) {
    const std::vector<double> periods = atlas->column("period", name);
    const std::vector<double> energies = atlas->column("energy", name);
    for (std::size_t n = 0; n < periods.size(); ++n) {
      for (const double period : wanted_periods) {
        at_period += periods[n] == period ? 1 : 0;
        if (n > 0) {
          EXPECT_GE((periods[n] - period) * (periods[n - 1] - period), 0.0) << name << " passes T = " << period;
        }
      }
      for (const double energy : wanted_energies) {
        at_energy += std::abs(energies[n] - energy) < 1e-12 ? 1 : 0;
        if (n > 0) {
          EXPECT_GE((energies[n] - energy) * (energies[n - 1] - energy), -1e-12) << name << " passes E = " << energy;
        }
      }
    }
  }
  EXPECT_EQ(at_period, 7 + 10);  // base families, OD's two and OB; base families, ID1's and OD's two, IB and OB
  EXPECT_EQ(at_energy, 6 + 8);   // In-Phase, Out-Phase, ID1's and OD's two; base families, OD's two, IB and OB
  EXPECT_THAT(atlas->orbits().reals("loss_rms"), Each(::testing::Le(1e-10)));
}

TEST_F(Tree, StepsFollowOneAnotherAndArclengthGrows) {
  const auto& family = atlas->orbits().integers("family");
  const auto& steps = atlas->orbits().integers("step");
  const auto& arclengths = atlas->orbits().reals("arclength");
  for (std::size_t row = 1; row < steps.size(); ++row) {
    if (family[row] != family[row - 1]) continue;
    EXPECT_EQ(steps[row], steps[row - 1] + 1) << row;
    EXPECT_GT(arclengths[row], arclengths[row - 1]) << row;
  }
}

}  // namespace
}  // namespace tree_test
