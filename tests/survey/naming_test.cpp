#include "orbweaver/survey/tree/naming.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace naming_test {
namespace {

using namespace orbweaver;
constexpr double pi = std::numbers::pi;

std::string named(const scene::Scene& scene, const std::vector<double>& point, int mode, int index = 0) {
  return survey::base_family_name(scene, *systems::make_system("double_pendulum"), point, index, mode);
}

scene::Scene scene_with_names() {
  scene::Scene scene;
  scene.fixed_points.names = {{{0.0, 0.0}, {"Slow", "Fast"}}, {{0.0, pi}, {"Down-Up"}}, {{pi}, {"By th1 alone"}}};
  return scene;
}

TEST(Naming, TakesTheScenesNamesInOrder) {
  const scene::Scene scene = scene_with_names();
  EXPECT_EQ(named(scene, {0.0, 0.0, 0.0, 0.0}, 0), "Slow");
  EXPECT_EQ(named(scene, {0.0, 0.0, 0.0, 0.0}, 1), "Fast");
  EXPECT_EQ(named(scene, {0.0, pi, 0.0, 0.0}, 0), "Down-Up");
}

TEST(Naming, AnglesCountModuloATurn) {
  const scene::Scene scene = scene_with_names();
  EXPECT_EQ(named(scene, {2.0 * pi - 1e-9, -4.0 * pi, 0.0, 0.0}, 0), "Slow");
  EXPECT_EQ(named(scene, {0.0, -pi, 0.0, 0.0}, 0), "Down-Up");
  EXPECT_EQ(named(scene, {1e-5, 0.0, 0.0, 0.0}, 0), "Equilibrium 1, mode 1");
}

TEST(Naming, VelocitiesDoNotWrap) {
  scene::Scene scene;
  scene.fixed_points.names = {{{0.0, 0.0, 2.0 * pi}, {"Spinning"}}};
  EXPECT_EQ(named(scene, {0.0, 0.0, 0.0, 0.0}, 0), "Equilibrium 1, mode 1");
  EXPECT_EQ(named(scene, {0.0, 0.0, 2.0 * pi, 0.0}, 0), "Spinning");
}

TEST(Naming, CoordinatesThatAreNotGivenDoNotMatter) {
  EXPECT_EQ(named(scene_with_names(), {pi, 1.0, 2.0, 3.0}, 0), "By th1 alone");
}

TEST(Naming, CountsTheNamesOfAPlace) {
  const auto system = systems::make_system("double_pendulum");
  EXPECT_EQ(survey::names_given(scene_with_names(), *system, {0.0, 2.0 * pi, 0.0, 0.0}), 2U);
  EXPECT_EQ(survey::names_given(scene_with_names(), *system, {0.0, 1.0, 0.0, 0.0}), 0U);
}

TEST(Naming, RefusesAPlaceWhereNothingRests) {
  const auto system = systems::make_system("double_pendulum");
  scene::Scene scene = scene_with_names();
  const std::vector<std::vector<double>> known{{0.0, 0.0, 0.0, 0.0}};
  EXPECT_NO_THROW(survey::require_named(scene, *system, known)) << "[0, 180] rests, though it is not among them";
  scene.fixed_points.names.push_back({{0.0, 0.3}, {"Moved"}});
  try {
    survey::require_named(scene, *system, known);
    FAIL() << "nothing rests at th2 = 0.3";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("(Moved), where none is: the nearest known is [0, 0, 0, 0]"));
  }
}

TEST(Naming, CountsWhereTheSceneGivesNoName) {
  EXPECT_EQ(named(scene_with_names(), {0.0, 0.0, 0.0, 0.0}, 2, 4), "Equilibrium 5, mode 3");
  EXPECT_EQ(named(scene::Scene{}, {0.0, 0.0, 0.0, 0.0}, 0, 1), "Equilibrium 2, mode 1");
}

TEST(Naming, PointsAreTextInDegreesForAngles) {
  EXPECT_EQ(survey::point_text(*systems::make_system("double_pendulum"), {pi, -1e-15, 0.5, 0.0}),
            "th1 = 180 deg, th2 = 0 deg, w1 = 0.5, w2 = 0");
}

TEST(Naming, LongTextsAreCutToWhatAColumnHolds) {
  const std::string fits(2000, 'x');
  EXPECT_EQ(survey::limited(fits), fits);
  EXPECT_EQ(survey::limited(fits + "y"), fits + " ...");
}

}  // namespace
}  // namespace naming_test
