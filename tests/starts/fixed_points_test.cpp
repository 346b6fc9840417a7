#include "orbweaver/starts/fixed_points.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "corrector/oscillator.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/in_scales.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "support/text_model.hpp"

namespace orbweaver::starts::fixed_points_test {
namespace {

constexpr double pi = std::numbers::pi;

void expect_the_four_equilibria(const std::vector<std::vector<double>>& points) {
  const double angles[4][2] = {{0, 0}, {0, pi}, {pi, 0}, {pi, pi}};
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t n = 0; n < 4; ++n) {
    ASSERT_EQ(points[n].size(), 4u);
    EXPECT_NEAR(points[n][0], angles[n][0], 1e-14) << n;
    EXPECT_NEAR(points[n][1], angles[n][1], 1e-14) << n;
    EXPECT_NEAR(points[n][2], 0.0, 1e-14) << n;
    EXPECT_NEAR(points[n][3], 0.0, 1e-14) << n;
  }
}

TEST(FixedPoints, OfTheDoublePendulumFromTheScenesGrid) {
  const double degree = pi / 180.0;
  expect_the_four_equilibria(
      find_fixed_points(*systems::make_system("double_pendulum"), {{0.0, 180.0 * degree}, {0.0, 180.0 * degree}}));
}

TEST(FixedPoints, FromOffsetGuesses) {
  const auto system = systems::make_system("double_pendulum", {{"m1", 2.0}, {"l2", 0.7}, {"g", 9.81}});
  expect_the_four_equilibria(find_fixed_points(*system, {{0.2, pi - 0.1}, {-0.15, pi + 0.2}}));
  // Velocities and whole turns lead to the same four.
  expect_the_four_equilibria(
      find_fixed_points(*system, {{2 * pi + 0.1, -pi + 0.1}, {0.1, 3 * pi - 0.1, -2 * pi}, {0.05}, {-0.05, 0.1}}));
}

TEST(FixedPoints, OfHenonHeiles) {
  const auto points = find_fixed_points(*systems::make_system("henon_heiles"), {{-1.0, 0.0, 1.0}, {-0.6, 0.1, 1.1}});
  ASSERT_EQ(points.size(), 4u);  // the origin and the triangle's three saddles
  const double x = std::sqrt(3.0) / 2.0;
  const double wanted[4][2] = {{-x, -0.5}, {0.0, 0.0}, {0.0, 1.0}, {x, -0.5}};
  for (const auto& w : wanted) {
    const bool found = std::any_of(points.begin(), points.end(),
                                   [&](const auto& p) { return std::hypot(p[0] - w[0], p[1] - w[1]) < 1e-13; });
    EXPECT_TRUE(found) << w[0] << " " << w[1];
  }
}

// Each point where the scene names it, to the digits that names are given with.
TEST(FixedPoints, OfTheThreeBodyScenesAreTheFiveLagrangePoints) {
  for (const char* file : {"pcr3bp_earth_moon.yaml", "pcr3bp_mu_0.001.yaml"}) {
    SCOPED_TRACE(file);
    const scene::Scene scene = scene::load(std::string(ORBWEAVER_SOURCE_DIR "/drivers/scenes/") + file);
    const auto system = systems::make_system(scene.system.name, scene.system.parameters);
    const auto points = find_fixed_points(*system, scene.fixed_points.grid);
    ASSERT_EQ(points.size(), 5u);
    ASSERT_EQ(scene.fixed_points.names.size(), 5u);
    for (const auto& named : scene.fixed_points.names) {
      const auto places = std::count_if(points.begin(), points.end(), [&](const auto& p) {
        return std::hypot(p[0] - named.point[0], p[1] - named.point[1]) < 1e-9;
      });
      EXPECT_EQ(places, 1) << named.names.front();
    }
  }
}

// L4 and L5 have one x, to rounding: their order may not hang on its last digit, which other units change.
TEST(FixedPoints, MirrorImagesDoNotChangePlaces) {
  for (const char* file : {"pcr3bp_earth_moon.yaml", "pcr3bp_mu_0.001.yaml"}) {
    const scene::Scene scene = scene::load(std::string(ORBWEAVER_SOURCE_DIR "/drivers/scenes/") + file);
    const auto system = systems::make_system(scene.system.name, scene.system.parameters);
    for (const double speed : {1.0, 0.5, 0.25, 0.125})
      for (const double y : {1.0, 0.5, 0.25}) {
        const systems::Scales scales{2.0, {1.0, y, speed, 2.0 * speed}, {}, {}};
        const scene::Scene told = scene::in_scales(scene, *system, scales);
        const auto points = find_fixed_points(*systems::scaled(system, scales), told.fixed_points.grid);
        ASSERT_EQ(points.size(), 5u);
        for (std::size_t n = 1; n < points.size(); ++n) {
          if (std::abs(points[n][0] - points[n - 1][0]) > 1e-9) continue;
          EXPECT_LT(points[n - 1][1], points[n][1]) << file << " " << speed << " " << y;
        }
      }
  }
}

TEST(FixedPoints, OfTheSwingingSpringIsWhereItHangs) {
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml");
  const auto system = systems::make_system(scene.system.name, scene.system.parameters);
  const auto points = find_fixed_points(*system, scene.fixed_points.grid);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0][0], 0.0);
  EXPECT_NEAR(points[0][1], -4.0 / 3.0, 1e-15);
}

TEST(FixedPoints, EmptyGridStartsAtZero) {
  const auto points = find_fixed_points(*systems::make_system("harmonic_oscillator"), {});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0], (std::vector<double>{0.0, 0.0}));
}

TEST(FixedPoints, Misuse) {
  const auto system = systems::make_system("harmonic_oscillator");
  EXPECT_THROW(static_cast<void>(find_fixed_points(*system, {{0.0}, {0.0}, {0.0}})), core::MisuseError);
}

TEST(FixedPoints, AGridPointWhereTheFieldIsNotFiniteIsPassedOver) {
  const test::Oscillator walled(0.0, 0.5);
  std::vector<std::vector<double>> not_finite;
  EXPECT_EQ(find_fixed_points(walled, {{1.0, 0.4, 2.0}}, &not_finite).size(), 1u);
  EXPECT_EQ(not_finite, (std::vector<std::vector<double>>{{1.0, 0.0}, {2.0, 0.0}}));
  EXPECT_EQ(find_fixed_points(walled, {{0.4}}, &not_finite).size(), 1u);
  EXPECT_TRUE(not_finite.empty());
  EXPECT_THAT(([&] {
                static_cast<void>(find_fixed_points(walled, {{1.0, 2.0}}));
              }),
              testing::ThrowsMessage<core::InputError>(testing::HasSubstr("the first (z0 = 1, z1 = 0)")));
}

TEST(FixedPoints, ThoseNotFiniteAreToldInTheSystemsOwnScales) {
  const auto walled = test::text_system("name: walled\nequations: {x': v, v': -x*sqrt(4 - x^2)}\n");
  const auto scaled = systems::scaled(walled, {1.0, {2.0, 2.0}, {}, {}});
  std::vector<std::vector<double>> not_finite;
  static_cast<void>(find_fixed_points(*scaled, {{1.5, 0.1}}, &not_finite));
  EXPECT_EQ(not_finite, (std::vector<std::vector<double>>{{1.5, 0.0}}));
}

TEST(FixedPoints, WithoutAGridNoneIsFoundWhereTheFieldIsNotFinite) {
  std::vector<std::vector<double>> not_finite;
  EXPECT_TRUE(find_fixed_points(*systems::make_system("three_bodies"), {}, &not_finite).empty());
  EXPECT_EQ(not_finite.size(), 1u);
}

TEST(FixedPoints, TheOneNearAState) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> near{-pi + 0.01, 2 * pi + 0.02, 0.0, -0.01};
  const auto found = fixed_point_near(*system, near, 0.1);
  ASSERT_TRUE(found);
  const auto known = find_fixed_points(*system, {{0.0, pi}, {0.0, pi}});
  EXPECT_TRUE(is_same_fixed_point(*found, known[2]));
  EXPECT_FALSE(is_same_fixed_point(*found, known[3]));
  EXPECT_FALSE(fixed_point_near(*system, near, 0.01)) << "the nearest one is farther away";
}

}  // namespace
}  // namespace orbweaver::starts::fixed_points_test
