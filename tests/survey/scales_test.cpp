// The same system in other units: what a survey finds is the same, to the last bit where the units change by powers of
// two (docs/mathematics.md, "Scales").
#include "orbweaver/systems/scales.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
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

/// What numbers are multiplied by where the units change.
struct Factors {
  std::vector<double> coordinates;
  double time, energy, parameter;
};

/// Of positions, two of them, and their speeds.
Factors factors(const Units& units, double positions) {
  const double speeds = positions / units.time;
  return {{positions, positions, speeds, speeds}, units.time, units.energy(), 1.0};
}

/// The bits of a column, so that columns which are not computed are the same too.
std::vector<std::uint64_t> bits_of(std::vector<double> values, const std::vector<double>& by) {
  std::vector<std::uint64_t> bits;
  for (std::size_t n = 0; n < values.size(); ++n)
    bits.push_back(std::bit_cast<std::uint64_t>(values[n] * by[n % by.size()]));
  return bits;
}

void expect_same_bits(const test::Atlas& a, const test::Atlas& b, const Factors& by) {
  ASSERT_EQ(a.orbits().rows(), b.orbits().rows());
  ASSERT_EQ(a.crossings().rows(), b.crossings().rows());
  EXPECT_EQ(a.families().texts("name"), b.families().texts("name"));
  for (const bool crossings : {false, true}) {
    const archive::Table& of_a = crossings ? a.crossings() : a.orbits();
    const archive::Table& of_b = crossings ? b.crossings() : b.orbits();
    const auto expect_column = [&](const char* column, const std::vector<double>& factor) {
      EXPECT_EQ(bits_of(of_a.reals(column), factor), bits_of(of_b.reals(column), {1.0})) << column;
    };
    expect_column("period", {by.time});
    expect_column("energy", {by.energy});
    expect_column("parameter", {by.parameter});
    expect_column("state", by.coordinates);
    if (crossings) continue;
    expect_column("action", {by.energy * by.time});
    for (const char* column : {"stability", "closure", "loss_rms", "tail", "energy_drift"})
      expect_column(column, {1.0});
  }
  for (std::size_t row = 0; row < a.orbits().rows(); ++row)
    ASSERT_EQ(bits_of(a.modes(row), by.coordinates), bits_of(b.modes(row), {1.0})) << row;
}

/// Names, families and crossings the same; these to 1e-10.
void expect_same_tree(const test::Atlas& a, const test::Atlas& b, const Factors& by) {
  EXPECT_EQ(a.families().texts("name"), b.families().texts("name"));
  EXPECT_EQ(a.families().texts("isotropy"), b.families().texts("isotropy"));
  ASSERT_EQ(a.crossings().rows(), b.crossings().rows());
  EXPECT_EQ(a.crossings().texts("kind"), b.crossings().texts("kind"));
  EXPECT_EQ(a.crossings().integers("multiplicity"), b.crossings().integers("multiplicity"));
  const auto expect_near = [&](const char* column, double factor, std::size_t row) {
    const double value = a.crossings().reals(column)[row];
    const double other = b.crossings().reals(column)[row] / factor;
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(other)) << column << " " << row;
    } else {
      EXPECT_NEAR(other, value, 1e-10 * (1.0 + std::abs(value))) << column << " " << row;
    }
  };
  for (std::size_t row = 0; row < a.crossings().rows(); ++row) {
    expect_near("period", by.time, row);
    expect_near("energy", by.energy, row);
    expect_near("parameter", by.parameter, row);
  }
}

/// x'' + damping x' + x + x^3 = drive_amplitude cos(drive_frequency t) in other units, and `more`.
scene::Scene duffing(const Units& units, double damping, double amplitude, double frequency,
                     std::vector<std::string> more) {
  const double rate = 1.0 / units.time;
  for (const std::string& word :
       {fmt::format("system.parameters.damping={}", damping * rate),
        fmt::format("system.parameters.alpha={}", rate * rate),
        fmt::format("system.parameters.beta={}", rate * rate / (units.length * units.length)),
        fmt::format("system.parameters.drive_amplitude={}", amplitude * units.length * rate * rate),
        fmt::format("system.parameters.drive_frequency={}", frequency * rate),
        fmt::format("limits.period={}", 30.0 * units.time)})
    more.push_back(word);
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml", more);
}

/// The answer to each frequency, from a given state, with its two folds.
scene::Scene response(const Units& units) {
  return duffing(units, 0.1, 0.3, 0.5,
                 {fmt::format("starts={{states: [{{state: [{}, 0, 0], period: {}, name: Response}}]}}",
                              0.39 * units.length, 12.566370614359172 * units.time),
                  fmt::format("limits.parameter=[{}, {}]", 0.3 / units.time, 3.0 / units.time)});
}

/// The answers to a drive raised from zero: the symmetric one, and the pair without symmetry that leaves it.
scene::Scene raised(const Units& units) {
  return duffing(units, 0.2, 0.0, 1.3178123854595376,
                 {"starts={fixed_points: {grid: [[0]]}}", "continuation.free=drive_amplitude", "survey.depth=1",
                  "survey.subharmonics=2",
                  fmt::format("limits.parameter=[0, {}]", 12.0 * units.length / (units.time * units.time))});
}

Factors driven_factors(const Units& units, double parameter) {
  return {{units.length, units.length / units.time, 1.0}, units.time, units.energy(), parameter};
}

/// A pendulum that hangs still while its pivot goes up and down, and what leaves it.
scene::Scene shaken(const Units& units) {
  return scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
      {"name=shaken",
       fmt::format(
           "system={{name: double_pendulum, effects: [damping, pivot_drive], parameters: {{m1: {0}, m2: {0}, l1: "
           "{1}, l2: {1}, g: {2}, c1: {3}, c2: {3}, pivot_amplitude: {4}, drive_frequency: {5}}}}}",
           units.mass, units.length, units.length / (units.time * units.time),
           0.05 * units.mass * units.length * units.length / units.time, 0.1 * units.length, 1.6 / units.time),
       "starts={fixed_points: {grid: [[0], [0]]}}", "continuation.free=pivot_amplitude", "survey.depth=1",
       fmt::format("limits.parameter=[0, {}]", 0.3 * units.length),
       fmt::format("limits.period={}", 30.0 * units.time)});
}

Factors shaken_factors(const Units& units) {
  return {{1.0, 1.0, 1.0 / units.time, 1.0 / units.time, 1.0}, units.time, units.energy(), units.length};
}

TEST(Scales, APendulumInUnitsOfPowersOfTwoHasTheSameBits) {
  const test::Atlas plain = survey_of(pendulum({}), "plain");
  EXPECT_THAT(plain.header().scale_names, testing::ElementsAre("time", "th1", "th2", "w1", "w2", "energy"));
  EXPECT_THAT(plain.header().scales, testing::Each(1.0));
  EXPECT_GE(plain.crossings().rows(), 2U);
  for (const Units& units :
       {Units{1.0, 0.5, 1.0}, Units{1.0, 0.25, 1.0}, Units{1.0, 32.0, 1.0}, Units{16.0, 1.0, 0x1p-9}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    expect_same_bits(plain, survey_of(pendulum(units), "other"), factors(units, 1.0));
  }
}

TEST(Scales, APendulumInOtherUnitsHasTheSameTree) {
  const test::Atlas plain = survey_of(pendulum({}), "plain");
  for (const Units& units :
       {Units{1.0, 0.1, 1.0}, Units{1.0, 0.01, 1.0}, Units{1e3, 1.0, 1e-3}, Units{1e-6, 1e3, 1e6}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    const test::Atlas other = survey_of(pendulum(units), "other");
    expect_same_tree(plain, other, factors(units, 1.0));
    EXPECT_NEAR(static_cast<double>(other.orbits().rows()), static_cast<double>(plain.orbits().rows()),
                0.1 * static_cast<double>(plain.orbits().rows()));
  }
}

TEST(Scales, ASpringInUnitsOfPowersOfTwoHasTheSameBits) {
  const test::Atlas plain = survey_of(spring({}), "plain");
  EXPECT_GE(plain.crossings().rows(), 2U);
  for (const Units& units : {Units{1024.0, 1.0, 1.0}, Units{0x1p-20, 8.0, 0x1p10}})
    expect_same_bits(plain, survey_of(spring(units), "other"), factors(units, units.length));
}

TEST(Scales, ASpringInOtherUnitsHasTheSameTree) {
  const test::Atlas plain = survey_of(spring({}), "plain");
  for (const Units& units : {Units{1e3, 1.0, 1.0}, Units{1e-6, 60.0, 1e3}, Units{1e6, 1e3, 1e-6}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", units.length, units.time, units.mass));
    expect_same_tree(plain, survey_of(spring(units), "other"), factors(units, units.length));
  }
}

TEST(Scales, DrivenSystemsInUnitsOfPowersOfTwoHaveTheSameBits) {
  const std::vector<Units> others{Units{0x1p17, 1.0, 1.0}, Units{0x1p-10, 16.0, 1.0}};
  const test::Atlas answers = survey_of(response({}), "response");
  EXPECT_THAT(answers.crossings().texts("kind"), testing::ElementsAre("fold-parameter", "fold-parameter"));
  const test::Atlas from_zero = survey_of(raised({}), "raised");
  EXPECT_EQ(from_zero.families().rows(), 2U);
  const test::Atlas hanging = survey_of(shaken({}), "shaken");
  EXPECT_GE(hanging.families().rows(), 2U);
  for (const Units& units : others) {
    SCOPED_TRACE(fmt::format("length {} time {}", units.length, units.time));
    const double force = units.length / (units.time * units.time);
    expect_same_bits(answers, survey_of(response(units), "other"), driven_factors(units, 1.0 / units.time));
    expect_same_bits(from_zero, survey_of(raised(units), "other"), driven_factors(units, force));
    const Units heavier{units.length, units.time, 4.0};
    expect_same_bits(hanging, survey_of(shaken(heavier), "other"), shaken_factors(heavier));
  }
}

TEST(Scales, DrivenSystemsInOtherUnitsHaveTheSameTree) {
  const test::Atlas answers = survey_of(response({}), "response");
  const test::Atlas from_zero = survey_of(raised({}), "raised");
  const test::Atlas hanging = survey_of(shaken({}), "shaken");
  for (const Units& units : {Units{1e5, 1.0, 1.0}, Units{1e-3, 60.0, 1.0}}) {
    SCOPED_TRACE(fmt::format("length {} time {}", units.length, units.time));
    const double force = units.length / (units.time * units.time);
    expect_same_tree(answers, survey_of(response(units), "other"), driven_factors(units, 1.0 / units.time));
    expect_same_tree(from_zero, survey_of(raised(units), "other"), driven_factors(units, force));
    const Units heavier{units.length, units.time, 3.0};
    expect_same_tree(hanging, survey_of(shaken(heavier), "other"), shaken_factors(heavier));
  }
}

TEST(Scales, OfTheSceneAreTaken) {
  const scene::Scene scene = test::quick_scene({"system.scales={time: 3, w1: 0.3, energy: 7}", "limits.period=10",
                                                "survey.depth=1", "survey.subharmonics=1", "events.periods=[8.5]"});
  const test::Atlas atlas = survey_of(scene, "given");
  EXPECT_THAT(atlas.header().scales, testing::ElementsAre(3.0, 1.0, 1.0, 0.3, 1.0, 7.0));
  expect_same_tree(survey_of(pendulum({}), "plain"), atlas, factors({}, 1.0));
}

TEST(Scales, AToleranceBelowRoundingIsToldOfOnceAFamily) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, test::quick_scene({"continuation.tolerance=1e-14", "limits.period=12"}), "tolerance");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  int told = 0;
  for (const std::string& remark : summary.remarks)
    if (remark.find("Out-Phase: the tolerance 1e-14 is below what rounding allows here: ") == 0) ++told;
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
