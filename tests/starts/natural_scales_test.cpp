#include "orbweaver/starts/natural_scales.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"
#include "support/magnetic_well.hpp"
#include "support/text_model.hpp"

namespace orbweaver::starts::natural_scales_test {
namespace {

constexpr double pi = std::numbers::pi;
using Grid = std::vector<std::vector<double>>;
using Parameters = std::map<std::string, double>;
using testing::ElementsAre;

const Grid straight{{0.0, pi}, {0.0, pi}};

systems::Scales pendulum(const Parameters& parameters) {
  return natural_scales(*systems::make_system("double_pendulum", parameters), straight);
}

/// Lengths, times and masses are told in units so many times smaller.
systems::Scales spring(double length, double time, double mass) {
  const auto system = systems::make_system("swinging_spring", {{"mass", mass},
                                                               {"stiffness", 3.0 * mass / (time * time)},
                                                               {"length", length},
                                                               {"gravity", length / (time * time)}});
  return natural_scales(*system, {{0.0}, {-1.3 * length}});
}

TEST(NaturalScales, AreOneWhereParametersAreOne) {
  EXPECT_TRUE(pendulum({}).are_one());
  EXPECT_TRUE(natural_scales(*systems::make_system("henon_heiles"), {{0.0}, {0.0}}).are_one());
}

TEST(NaturalScales, AreOneWhereNothingSaysHowLargeMotionsAre) {
  EXPECT_TRUE(natural_scales(*systems::make_system("harmonic_oscillator"), {{0.0}}).are_one());
}

TEST(NaturalScales, ChangeAsTheUnitsDo) {
  const systems::Scales fast = pendulum({{"g", 0x1p20}});
  EXPECT_EQ(fast.time, 0x1p-10);
  EXPECT_THAT(fast.coordinates, ElementsAre(1.0, 1.0, 0x1p10, 0x1p10));
  EXPECT_THAT(fast.conserved, ElementsAre(0x1p20));
  const systems::Scales heavy = pendulum({{"m1", 0x1p-9}, {"m2", 0x1p-9}, {"l1", 16.0}, {"l2", 16.0}});
  EXPECT_EQ(heavy.time, 4.0);
  EXPECT_THAT(heavy.coordinates, ElementsAre(1.0, 1.0, 0.25, 0.25));
  EXPECT_THAT(heavy.conserved, ElementsAre(0x1p-5));
  const systems::Scales metres = spring(1.0, 1.0, 1.0);
  for (const double length : {0x1p-20, 0x1p20})
    for (const double time : {0x1p-10, 0x1p10})
      for (const double mass : {0x1p-20, 0x1p20}) {
        const systems::Scales scales = spring(length, time, mass);
        EXPECT_EQ(scales.time, time * metres.time);
        EXPECT_EQ(scales.coordinates[0], length * metres.coordinates[0]);
        EXPECT_EQ(scales.coordinates[1], length * metres.coordinates[1]);
        EXPECT_EQ(scales.coordinates[2], length / time * metres.coordinates[2]);
        EXPECT_EQ(scales.coordinates[3], length / time * metres.coordinates[3]);
        EXPECT_EQ(scales.conserved[0], mass * length * length / (time * time) * metres.conserved[0]);
      }
}

TEST(NaturalScales, AreThatOfTheMotionsThemselves) {
  const systems::Scales metres = spring(1.0, 1.0, 1.0);
  EXPECT_THAT(metres.time, testing::AnyOf(0.5, 1.0));
  for (const double scale : metres.coordinates) EXPECT_THAT(scale, testing::AllOf(testing::Ge(0.25), testing::Le(2.0)));
  for (const double mass : {1e-6, 1e6}) {
    const systems::Scales scales = pendulum({{"m2", mass}});
    const double fast = std::sqrt(std::max(mass, 1.0));
    for (const double speed : {scales.coordinates[2], scales.coordinates[3]})
      EXPECT_THAT(speed, testing::AllOf(testing::Ge(0.25), testing::Le(2.0 * fast)));
  }
}

/// x'' + x' / 10 + x + stiffening x^3 = drive cos(phase): how strong the drive is does not matter where the spring
/// stiffens.
systems::Scales driven_spring(double stiffening, double drive) {
  return natural_scales(
      *systems::make_system(
          "duffing", {{"beta", stiffening}, {"damping", 0.1}, {"drive_amplitude", drive}, {"drive_frequency", 2.0}},
          {"damping", "drive"}),
      {{0.0}});
}

TEST(NaturalScales, OfDrivenSystemsAreThoseOfTheirMeanOverTheDrive) {
  const systems::Scales metres = driven_spring(1.0, 0.0);
  EXPECT_THAT(metres.coordinates, ElementsAre(1.0, 1.0, 1.0));
  for (const double drive : {0.3, 20.0}) EXPECT_EQ(driven_spring(1.0, drive), metres) << drive;
  for (const double drive : {0.0, 0.3 * 0x1p17, 20.0}) {
    const systems::Scales far = driven_spring(0x1p-34, drive);
    EXPECT_EQ(far.time, 1.0);
    EXPECT_THAT(far.coordinates, ElementsAre(0x1p17, 0x1p17, 1.0)) << drive;
  }
}

TEST(NaturalScales, OfALinearSystemAreThoseOfWhatDrivesIt) {
  EXPECT_THAT(driven_spring(0.0, 0x1p17).coordinates, ElementsAre(0x1p17, 0x1p17, 1.0));
  EXPECT_TRUE(driven_spring(0.0, 0.0).are_one());
}

/// 3 N m hold no pendulum of 1 kg and 1 m at g = 1 m/s^2 up: it rests nowhere. Its time is still that of its weight.
TEST(NaturalScales, OfADrivenSystemWithoutRestAreThoseOfTheGrid) {
  const auto turned = [](double gravity) {
    return natural_scales(*systems::make_system("double_pendulum",
                                                {{"g", gravity},
                                                 {"c1", 0.2 * std::sqrt(gravity)},
                                                 {"c2", 0.2 * std::sqrt(gravity)},
                                                 {"torque1", 3.0 * gravity},
                                                 {"torque1_amplitude", gravity},
                                                 {"drive_frequency", 0.9 * std::sqrt(gravity)}},
                                                {"damping", "joint_torque"}),
                          {});
  };
  EXPECT_TRUE(turned(1.0).are_one());
  EXPECT_EQ(turned(0x1p20).time, 0x1p-10);
  EXPECT_THAT(turned(0x1p20).coordinates, ElementsAre(1.0, 1.0, 0x1p10, 0x1p10, 1.0));
}

/// A rod on a turntable of the rate w, pulled to a line that rests: in the table's frame the torque turns once a half
/// turn of the drive, and its mean over the drive is none.
systems::Scales of_turning_torque(double torque, double rate) {
  const auto table = test::text_system(
      "name: turntable\n"
      "equations: {a': r, r': -torque*sin(2*(a - w*t))}\n"
      "angles: [a]\n"
      "drive: {frequency: w}\n"
      "parameters: {torque: 0.5, w: 1}\n",
      {}, {{"torque", torque}, {"w", rate}});
  return natural_scales(*table, {{0.0}});
}

TEST(NaturalScales, OfAPullThatTurnsWithTheDriveAreThoseOfThePull) {
  const systems::Scales slow = of_turning_torque(0.5, 1.0);
  EXPECT_EQ(slow.time, 1.0);
  EXPECT_THAT(slow.coordinates, ElementsAre(1.0, 1.0, 1.0));
  const systems::Scales fast = of_turning_torque(0.5 * 0x1p20, 0x1p10);
  EXPECT_EQ(fast.time, 0x1p-10);
  EXPECT_THAT(fast.coordinates, ElementsAre(1.0, 0x1p10, 1.0));
}

// A term that departs from its linear part late, along the momenta only.
TEST(NaturalScales, AreNotThoseOfWeakTerms) {
  const auto scales = [](double b) {
    return natural_scales(*test::magnetic_well({{"k2", 9.0}, {"b", b}, {"e", 0.1}, {"q", 0.2}}), {{0.0}, {0.0}});
  };
  const systems::Scales without = scales(0.0);  // two oscillators, each with its own
  const systems::Scales least = scales(1e-9);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_THAT(least.coordinates[i] / without.coordinates[i], testing::AllOf(testing::Ge(0.25), testing::Le(4.0)));
  for (const double b : {1e-6, 1e-3, 0.02}) EXPECT_EQ(scales(b).coordinates, least.coordinates) << b;
}

}  // namespace
}  // namespace orbweaver::starts::natural_scales_test
