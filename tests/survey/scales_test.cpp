// The same system in other units: what a survey finds is the same, to the last bit where the units change by powers of
// two (docs/mathematics.md, "Scales").
#include "orbweaver/systems/scales.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/atlas.hpp"
#include "survey/scenes.hpp"

namespace scales_test {
namespace {

using namespace orbweaver;
using testing::HasSubstr;

/// How many of the new units are in an old one.
struct Units {
  double length = 1.0;
  double time = 1.0;
  double mass = 1.0;

  [[nodiscard]] double energy() const { return mass * length * length / (time * time); }
};

scene::Scene pendulum(const Units& units) {
  return test::quick_scene(
      {fmt::format("system.parameters.m1={}", units.mass), fmt::format("system.parameters.m2={}", units.mass),
       fmt::format("system.parameters.l1={}", units.length), fmt::format("system.parameters.l2={}", units.length),
       fmt::format("system.parameters.g={}", units.length / (units.time * units.time)),
       fmt::format("starts.sweep.period=[{}, {}]", 2.0 * units.time, 9.0 * units.time),
       fmt::format("starts.sweep.step={}", 0.05 * units.time), fmt::format("limits.period={}", 10.0 * units.time),
       fmt::format("events.periods=[{}]", 8.5 * units.time), "survey.depth=1", "survey.subharmonics=1"});
}

scene::Scene spring(const Units& units) {
  const double rest = -1.333 * units.length;
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml",
                     {fmt::format("system.parameters.mass={}", units.mass),
                      fmt::format("system.parameters.stiffness={}", 3.0 * units.mass / (units.time * units.time)),
                      fmt::format("system.parameters.length={}", units.length),
                      fmt::format("system.parameters.gravity={}", units.length / (units.time * units.time)),
                      fmt::format("starts.fixed_points.grid=[[0], [{}]]", rest), "starts.fixed_points.names={}",
                      "starts.fixed_points.letters={}",
                      fmt::format("starts.sweep.period=[{}, {}]", 3.0 * units.time, 8.0 * units.time),
                      fmt::format("continuation.start={}", 0.01 * units.length), "survey.depth=1",
                      "survey.subharmonics=2", fmt::format("limits.period={}", 30.0 * units.time),
                      fmt::format("limits.energy=[-.inf, {}]", 0.5 * units.energy())});
}

test::Atlas survey_of(const scene::Scene& scene, const std::string& name) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, scene, name);
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  return test::Atlas(summary.atlas);
}

/// Factors of a state's coordinates: those of positions, then those of speeds.
void expect_same_bits(const test::Atlas& a, const test::Atlas& b, const Units& units, double positions) {
  const double speeds = positions / units.time;
  ASSERT_EQ(a.orbits().rows(), b.orbits().rows());
  ASSERT_EQ(a.crossings().rows(), b.crossings().rows());
  EXPECT_EQ(a.families().texts("name"), b.families().texts("name"));
  const auto times = [](std::vector<double> values, double factor) {
    for (double& v : values) v *= factor;
    return values;
  };
  for (const bool crossings : {false, true}) {
    const archive::Table& of_a = crossings ? a.crossings() : a.orbits();
    const archive::Table& of_b = crossings ? b.crossings() : b.orbits();
    EXPECT_EQ(times(of_a.reals("period"), units.time), of_b.reals("period"));
    EXPECT_EQ(times(of_a.reals("energy"), units.energy()), of_b.reals("energy"));
    std::vector<double> states = of_a.reals("state");
    for (std::size_t n = 0; n < states.size(); ++n) states[n] *= n % 4 < 2 ? positions : speeds;
    EXPECT_EQ(states, of_b.reals("state"));
  }
  EXPECT_EQ(times(a.orbits().reals("action"), units.energy() * units.time), b.orbits().reals("action"));
  for (const char* column : {"stability", "closure", "loss_rms", "tail", "energy_drift"})
    EXPECT_EQ(a.orbits().reals(column), b.orbits().reals(column)) << column;
  for (std::size_t row = 0; row < a.orbits().rows(); ++row) {
    std::vector<double> modes = a.modes(row);
    for (std::size_t n = 0; n < modes.size(); ++n) modes[n] *= n % 4 < 2 ? positions : speeds;
    ASSERT_EQ(modes, b.modes(row)) << row;
  }
}

/// Names, families and crossings the same; these to 1e-10.
void expect_same_tree(const test::Atlas& a, const test::Atlas& b, const Units& units) {
  EXPECT_EQ(a.families().texts("name"), b.families().texts("name"));
  EXPECT_EQ(a.families().texts("isotropy"), b.families().texts("isotropy"));
  ASSERT_EQ(a.crossings().rows(), b.crossings().rows());
  EXPECT_EQ(a.crossings().texts("kind"), b.crossings().texts("kind"));
  EXPECT_EQ(a.crossings().integers("multiplicity"), b.crossings().integers("multiplicity"));
  for (std::size_t row = 0; row < a.crossings().rows(); ++row) {
    const double period = a.crossings().reals("period")[row];
    EXPECT_NEAR(b.crossings().reals("period")[row] / units.time, period, 1e-10 * period) << row;
    const double energy = a.crossings().reals("energy")[row];
    EXPECT_NEAR(b.crossings().reals("energy")[row] / units.energy(), energy, 1e-10 * (1.0 + std::abs(energy))) << row;
  }
}

TEST(Scales, APendulumInUnitsOfPowersOfTwoHasTheSameBits) {
  const test::Atlas plain = survey_of(pendulum({}), "plain");
  EXPECT_THAT(plain.header().scale_names, testing::ElementsAre("time", "th1", "th2", "w1", "w2", "energy"));
  EXPECT_THAT(plain.header().scales, testing::Each(1.0));
  EXPECT_GE(plain.crossings().rows(), 2U);
  for (const Units& units :
       {Units{1.0, 0.5, 1.0}, Units{1.0, 0.25, 1.0}, Units{1.0, 32.0, 1.0}, Units{16.0, 1.0, 0x1p-9}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    expect_same_bits(plain, survey_of(pendulum(units), "other"), units, 1.0);
  }
}

TEST(Scales, APendulumInOtherUnitsHasTheSameTree) {
  const test::Atlas plain = survey_of(pendulum({}), "plain");
  for (const Units& units :
       {Units{1.0, 0.1, 1.0}, Units{1.0, 0.01, 1.0}, Units{1e3, 1.0, 1e-3}, Units{1e-6, 1e3, 1e6}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    const test::Atlas other = survey_of(pendulum(units), "other");
    expect_same_tree(plain, other, units);
    EXPECT_NEAR(static_cast<double>(other.orbits().rows()), static_cast<double>(plain.orbits().rows()),
                0.1 * static_cast<double>(plain.orbits().rows()));
  }
}

TEST(Scales, ASpringInUnitsOfPowersOfTwoHasTheSameBits) {
  const test::Atlas plain = survey_of(spring({}), "plain");
  EXPECT_GE(plain.crossings().rows(), 2U);
  for (const Units& units : {Units{1024.0, 1.0, 1.0}, Units{0x1p-20, 8.0, 0x1p10}})
    expect_same_bits(plain, survey_of(spring(units), "other"), units, units.length);
}

TEST(Scales, ASpringInOtherUnitsHasTheSameTree) {
  const test::Atlas plain = survey_of(spring({}), "plain");
  for (const Units& units : {Units{1e3, 1.0, 1.0}, Units{1e-6, 60.0, 1e3}, Units{1e6, 1e3, 1e-6}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    expect_same_tree(plain, survey_of(spring(units), "other"), units);
  }
}

TEST(Scales, OfTheSceneAreTaken) {
  const scene::Scene scene = test::quick_scene({"system.scales={time: 3, w1: 0.3, energy: 7}", "limits.period=10",
                                                "survey.depth=1", "survey.subharmonics=1", "events.periods=[8.5]"});
  const test::Atlas atlas = survey_of(scene, "given");
  EXPECT_THAT(atlas.header().scales, testing::ElementsAre(3.0, 1.0, 1.0, 0.3, 1.0, 7.0));
  expect_same_tree(survey_of(pendulum({}), "plain"), atlas, {});
}

TEST(Scales, AToleranceBelowRoundingIsToldOfOnceAFamily) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, test::quick_scene({"continuation.tolerance=1e-14", "limits.period=12"}), "tolerance");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  int told = 0;
  for (const std::string& remark : summary.remarks)
    if (remark.find("0000.0001: the tolerance 1e-14 is below what rounding allows here: ") == 0) ++told;
  EXPECT_EQ(told, 1) << testing::PrintToString(summary.remarks);
}

TEST(Scales, ATaskIsReadInTheScalesItWasMadeIn) {
  const scene::Scene scene = test::quick_scene({"system.parameters.g=16"});
  const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  const survey::ScaledScene scaled(scene, system);
  EXPECT_EQ(scaled.system()->scales().time, 0.25);
  EXPECT_EQ(scaled.scene().limits.period, 4.0 * scene.limits.period);
  EXPECT_NO_THROW(scaled.expect(scaled.system()->scales()));
  EXPECT_THROW(scaled.expect({}), core::InputError);
}

}  // namespace
}  // namespace scales_test
