// Folds and requested orbits at a family's ends, and beside folds: the step decides nothing.
#include <algorithm>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/even_well.hpp"
#include "support/moved_system.hpp"
#include "survey/atlas.hpp"
#include "survey/rotator.hpp"
#include "survey/scenes.hpp"

namespace end_folds_test {
namespace {

using namespace orbweaver;
using testing::DoubleNear;

/// The rotator's only family: T falls from 2 pi to 2 pi/1.001 at I = 0.02, and rises again.
test::Atlas rotator(const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  const scene::Scene scene = scene::parse(
      "system: {name: harmonic_oscillator, scales: {time: 1, q: 1, energy: 1}}\n"
      "starts: {fixed_points: {grid: [[0]]}, sweep: {period: [6, 6.5], step: 0.05}}\n"
      "compute: {certificate: none}\n",
      "rotator", overrides);
  const auto folder = test::fresh_folder("rotator_ends", comm.get());
  const survey::Summary summary = survey::run_survey(comm, scene, std::make_shared<const test::Rotator>(), folder, {});
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  return test::Atlas(summary.atlas);
}

double energy_at(double action) { return action + 0.05 * action * action - 2.5 / 3.0 * action * action * action; }

TEST(EndFolds, FoldShortlyBeforeALimitIsFoundOnceAtEveryStep) {
  for (const double step : {0.2, 0.05, 0.02}) {
    SCOPED_TRACE(step);
    const test::Atlas atlas = rotator(
        {fmt::format("limits.energy=[-.inf, {}]", energy_at(0.0205)), fmt::format("continuation.step={}", step)});
    ASSERT_EQ(atlas.crossings().rows(), 1U);
    EXPECT_EQ(atlas.crossings().texts("kind")[0], "fold-period");
    EXPECT_NEAR(atlas.crossings().reals("period")[0], 2.0 * std::numbers::pi / 1.001, 1e-10);
    EXPECT_NEAR(atlas.crossings().reals("energy")[0], energy_at(0.02), 1e-8);
  }
}

TEST(EndFolds, PeriodThatIsPassedTwiceBetweenTwoOrbitsIsStoredTwice) {
  // 1 + I/10 - 5 I^2/2 is the same at I = 0.02 - d and 0.02 + d.
  constexpr double d = 0.001;
  const double wanted = 2.0 * std::numbers::pi / (1.001 - 2.5 * d * d);
  for (const double step : {0.2, 0.05, 0.005}) {
    SCOPED_TRACE(step);
    const test::Atlas atlas = rotator({"limits.energy=[-.inf, 0.1]", fmt::format("continuation.step={}", step),
                                       fmt::format("events.periods=[{:.17g}]", wanted)});
    std::vector<double> energies;
    const std::vector<double>& periods = atlas.orbits().reals("period");
    for (std::size_t n = 0; n < periods.size(); ++n)
      if (std::abs(periods[n] - wanted) < 1e-12) energies.push_back(atlas.orbits().reals("energy")[n]);
    EXPECT_THAT(energies,
                testing::ElementsAre(DoubleNear(energy_at(0.02 - d), 1e-7), DoubleNear(energy_at(0.02 + d), 1e-7)));
    const std::vector<double>& along = atlas.orbits().reals("arclength");
    EXPECT_TRUE(std::is_sorted(along.begin(), along.end()));
  }
}

// Where Cap is gone around three times the resonance is weak: an index is 2 to rounding on the way to the first orbit.
TEST(EndFolds, FoldsBesideABirthAreFoundWhereverTheFirstOrbitIs) {
  const core::Communicator comm;
  for (const std::string start : {"0.001", "0.01", "0.1"}) {
    SCOPED_TRACE(start);
    const scene::Scene scene =
        scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml",
                    {"starts.fixed_points.names={}", "starts.fixed_points.letters={}", "system.parameters.stiffness=4",
                     "limits.energy=[-.inf, -0.85]", "continuation.start=" + start});
    const survey::Summary summary = test::run(comm, scene, "weak_birth");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    const test::Atlas atlas(summary.atlas);
    const std::string family = "Equilibrium 1, mode 1 T3-2";
    const auto energy = atlas.crossing(family, "fold-energy", 23.36694657);
    const auto period = atlas.crossing(family, "fold-period", 23.36694823);
    ASSERT_TRUE(energy.has_value() && period.has_value());
    EXPECT_NEAR(atlas.crossings().reals("energy")[*energy], -0.9163831662, 1e-9);
    EXPECT_NEAR(atlas.crossings().reals("energy")[*period], -0.91638219, 1e-7);
  }
}

survey::Summary even_well(const std::map<std::string, double>& parameters, const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  std::vector<std::string> all{"starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                               "starts.sweep.period=auto", "survey.subharmonics=3"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
  const auto folder = test::fresh_folder("even_well", comm.get());
  survey::Summary summary = survey::run_survey(comm, scene, test::even_well(parameters), folder, {});
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_NE(line.severity, survey::Severity::contradiction) << line.text;
  return summary;
}

const std::map<std::string, double> round_well{{"k1", 1.0}, {"k2", 1.0}, {"a", 1.0}, {"b", -0.2},
                                               {"c", 0.1},  {"d", 0.05}, {"e", 0.2}};

std::vector<double> energies_of(const test::Atlas& atlas, const std::string& family, const std::string& kind) {
  std::vector<double> energies;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().integers("family")[row] == static_cast<std::int64_t>(atlas.row_of(family)) &&
        atlas.crossings().texts("kind")[row] == kind)
      energies.push_back(atlas.crossings().reals("energy")[row]);
  return energies;
}

// From orbit to orbit T rises all the same where the first is near: between two of them it has risen by 4e-6 and fallen
// by 7e-6.
TEST(EndFolds, PairsThatStepsPassAreFound) {
  for (const std::string start : {"0.003", "0.0087", "0.02"}) {
    SCOPED_TRACE(start);
    const survey::Summary summary = even_well(round_well, {"continuation.start=" + start, "survey.depth=1",
                                                           "limits.energy=[-.inf, 0.37]", "limits.period=25"});
    EXPECT_THAT(energies_of(test::Atlas(summary.atlas), "Equilibrium 1, mode 3 T3-1", "fold-period"),
                testing::UnorderedElementsAre(DoubleNear(0.1527438498, 1e-9), DoubleNear(0.1529425093, 1e-9),
                                              DoubleNear(0.2785292247, 1e-9)));
  }
}

// About coordinates of 1e5 a state is known to 1.5e-11.
survey::Summary far_even_well(const std::map<std::string, double>& parameters,
                              const std::vector<std::string>& overrides) {
  const core::Communicator comm;
  std::vector<std::string> all{"starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                               "starts.fixed_points.grid=[[1e5], [1e5], [1e5], [1e5]]", "starts.sweep.period=auto",
                               "survey.subharmonics=3"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
  const auto folder = test::fresh_folder("far_even_well", comm.get());
  const auto far = test::translated_system(test::even_well(parameters), Eigen::Vector4d::Constant(1e5));
  survey::Summary summary = survey::run_survey(comm, scene, far, folder, {});
  EXPECT_TRUE(summary.failed_tasks.empty()) << testing::PrintToString(summary.failed_tasks);
  return summary;
}

// T is known better than an orbit is across its family, and with it the pair; E is not, of which the fold beside the
// birth is 5e-9 from it.
TEST(EndFolds, FarFromTheOriginTheSameAreFoundWhereverTheFirstOrbitIs) {
  for (const std::string start : {"0.003", "0.0087", "0.02"}) {
    SCOPED_TRACE(start);
    const survey::Summary summary = far_even_well(round_well, {"continuation.start=" + start, "survey.depth=1",
                                                               "limits.energy=[-.inf, 0.37]", "limits.period=25"});
    const test::Atlas atlas(summary.atlas);
    const std::string family = "Equilibrium 1, mode 3 T3-1";
    EXPECT_THAT(energies_of(atlas, family, "fold-period"),
                testing::UnorderedElementsAre(DoubleNear(0.1527438498, 1e-7), DoubleNear(0.1529425093, 1e-7),
                                              DoubleNear(0.2785292247, 1e-7)));
    EXPECT_TRUE(energies_of(atlas, family, "fold-energy").empty());
  }
}

// Two oscillators: T is one number along each family, and what its orbits show of it is rounding.
TEST(EndFolds, FarFromTheOriginNoneAreFoundWhereNothingTurns) {
  const std::map<std::string, double> oscillators{{"k1", 1.0}, {"k2", 2.0}, {"a", 0.0}, {"b", 0.0},
                                                  {"c", 0.0},  {"d", 0.0},  {"e", 0.0}};
  for (const std::string start : {"0.003", "0.0087", "0.02"}) {
    SCOPED_TRACE(start);
    const survey::Summary summary =
        far_even_well(oscillators, {"continuation.start=" + start, "survey.depth=0", "limits.energy=[-.inf, 3]"});
    EXPECT_EQ(summary.failures, 0U);
    EXPECT_EQ(summary.families.size(), 2U);
    EXPECT_EQ(test::Atlas(summary.atlas).crossings().rows(), 0U);
  }
}

// An index is 2 to 1e-8 along a whole branch, and to rounding near its end: tangents turn to the family that is met.
// The meeting is from shooting with 33 digits. There the index is known to 2e-10 and rises by 5.4e-4 a unit of T.
TEST(EndFolds, NoneWhereRoundingTellsNoSlopes) {
  const survey::Summary summary =
      even_well({{"k1", 1.0}, {"k2", 9.0}, {"a", 0.1}, {"b", 0.1}, {"c", 0.25}, {"d", 0.1}, {"e", 0.3}},
                {"continuation.start=0.003", "survey.depth=2", "limits.energy=[-.inf, 27.53]", "limits.period=20",
                 "starts.sweep.period=[6, 6.5]"});
  const test::Atlas atlas(summary.atlas);
  const std::string between = "Equilibrium 1, mode 1 T3-2aB";
  EXPECT_EQ(atlas.end_of(between).find("joined Equilibrium 1, mode 1 T3-2b at T = 12.162177"), 0U);
  const auto meeting = atlas.crossing("Equilibrium 1, mode 1 T3-2b", "branch-point", 12.1621772);
  ASSERT_TRUE(meeting.has_value());
  EXPECT_NEAR(atlas.crossings().reals("period")[*meeting], 12.1621771936893, 4e-7);
  EXPECT_TRUE(energies_of(atlas, between, "fold-period").empty());
  EXPECT_TRUE(energies_of(atlas, between, "fold-energy").empty());
}

}  // namespace
}  // namespace end_folds_test
