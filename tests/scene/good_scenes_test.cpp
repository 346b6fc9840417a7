#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"

namespace good_scenes_test {
namespace {

namespace fs = std::filesystem;
namespace scene = orbweaver::scene;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;
const fs::path source(ORBWEAVER_SOURCE_DIR);

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

scene::Scene every_key() { return scene::load(source / "tests/scene/good/every_key.yaml"); }

TEST(GoodScene, SystemIsRead) {
  const scene::Scene s = every_key();
  EXPECT_EQ(s.name, "every key");
  EXPECT_EQ(s.system.name, "double_pendulum");
  EXPECT_THAT(s.system.parameters,
              ElementsAre(Pair("g", 9.81), Pair("l1", 1.5), Pair("l2", 0.25), Pair("m1", 2.0), Pair("m2", 0.5)));
  EXPECT_THAT(s.system.effects, IsEmpty());
}

TEST(GoodScene, StartsAreReadWithAnglesInRadians) {
  const scene::Scene s = every_key();
  EXPECT_THAT(s.fixed_points.grid, ElementsAre(ElementsAre(0.0, pi / 2, -pi), ElementsAre(pi), ElementsAre(0.5)));
  ASSERT_EQ(s.fixed_points.names.size(), 2U);
  EXPECT_THAT(s.fixed_points.names[0].point, ElementsAre(0.0, pi));
  EXPECT_THAT(s.fixed_points.names[0].names, ElementsAre("Down-Up", "Second: quoted"));
  EXPECT_THAT(s.fixed_points.names[1].point, ElementsAre(pi));
  EXPECT_THAT(s.fixed_points.names[1].names, ElementsAre("Up-Down"));
  EXPECT_THAT(s.fixed_points.letters, ElementsAre(Pair("Down-Up", "DU")));
  EXPECT_EQ(s.sweep.period.value().from, 2.0);
  EXPECT_EQ(s.sweep.period.value().to, 8.5);
  EXPECT_EQ(s.sweep.step, 0.25);
}

TEST(GoodScene, ContinuationAndSurveyAreRead) {
  const scene::Scene s = every_key();
  ASSERT_TRUE(s.continuation.fixed_step.has_value());
  EXPECT_DOUBLE_EQ(*s.continuation.fixed_step, pi / 360);
  EXPECT_EQ(s.continuation.start_amplitude, 0.001);
  EXPECT_EQ(s.continuation.tolerance, 1e-11);
  EXPECT_EQ(s.continuation.cutoff_from, 16);
  EXPECT_EQ(s.continuation.cutoff_to, 16);
  EXPECT_EQ(s.continuation.corrector, "rprop-extrapolated");
  EXPECT_EQ(s.survey.depth, 3);
  EXPECT_EQ(s.survey.subharmonics, 4);
  EXPECT_EQ(s.survey.spectrum, scene::Spectrum::all);
  EXPECT_EQ(s.survey.team_size, 2);
}

TEST(GoodScene, LimitsEventsSectionAndOutputAreRead) {
  const scene::Scene s = every_key();
  EXPECT_EQ(s.limits.period, infinity);
  EXPECT_EQ(s.limits.energy_from, -1.5);
  EXPECT_EQ(s.limits.energy_to, infinity);
  EXPECT_EQ(s.limits.families, 7);
  EXPECT_EQ(s.limits.steps, 8);
  EXPECT_EQ(s.limits.time, 90.5);
  EXPECT_EQ(s.limits.task_time, 12.5);
  EXPECT_THAT(s.events.periods, ElementsAre(10.0, 12.5));
  EXPECT_THAT(s.events.energies, ElementsAre(-1.0, 0.0));
  EXPECT_EQ(s.section.coordinate, "th2");
  EXPECT_EQ(s.section.value, pi / 4);
  EXPECT_EQ(s.output.flush_seconds, 0.5);
  EXPECT_EQ(s.output.flush_orbits, 10);
}

TEST(GoodScene, ASectionOnAVelocityIsNotConverted) {
  const std::string text = "system: {name: double_pendulum}\nstarts: {}\nsection: {coordinate: w1, value: 45}\n";
  EXPECT_EQ(scene::parse(text, "text").section.value, 45.0);
}

TEST(GoodScene, LengthsWithoutAnglesAreInTheCoordinatesOwnUnits) {
  const std::string text = "system: {name: henon_heiles}\nstarts: {}\n";
  const scene::Scene s = scene::parse(text, "text", {"continuation.step=0.25", "continuation.start=2.5e3"});
  ASSERT_TRUE(s.continuation.fixed_step.has_value());
  EXPECT_EQ(*s.continuation.fixed_step, 0.25);
  EXPECT_EQ(s.continuation.start_amplitude, 2500.0);
  EXPECT_FALSE(scene::parse(text, "text", {"continuation.step=adaptive"}).continuation.fixed_step.has_value());
  EXPECT_DOUBLE_EQ(scene::parse(text, "text").continuation.start_amplitude, pi / 360);
}

TEST(GoodScene, EveryKeyButSystemAndStartsHasItsDefault) {
  const scene::Scene s = scene::parse("system: {name: double_pendulum}\nstarts: {}\n", "text");
  EXPECT_EQ(s.name, "double_pendulum");
  EXPECT_THAT(s.system.parameters, IsEmpty());
  EXPECT_THAT(s.fixed_points.grid, IsEmpty());
  EXPECT_FALSE(s.sweep.period.has_value()) << "auto";
  EXPECT_FALSE(s.sweep.step.has_value()) << "auto";
  EXPECT_FALSE(s.continuation.fixed_step.has_value());
  EXPECT_DOUBLE_EQ(s.continuation.start_amplitude, pi / 360);
  EXPECT_EQ(s.continuation.tolerance, 1e-10);
  EXPECT_EQ(s.continuation.cutoff_from, 8);
  EXPECT_EQ(s.continuation.cutoff_to, 4096);
  EXPECT_EQ(s.continuation.corrector, "automatic");
  EXPECT_EQ(s.survey.depth, 0);
  EXPECT_EQ(s.survey.subharmonics, 4);
  EXPECT_EQ(s.survey.spectrum, scene::Spectrum::events);
  EXPECT_EQ(s.survey.team_size, 1);
  EXPECT_EQ(s.limits.period, 30.0);
  EXPECT_EQ(s.limits.energy_from, -infinity);
  EXPECT_EQ(s.limits.energy_to, infinity);
  EXPECT_EQ(s.limits.families, 1000);
  EXPECT_EQ(s.limits.steps, 5000);
  EXPECT_EQ(s.limits.time, infinity);
  EXPECT_EQ(s.limits.task_time, infinity);
  EXPECT_THAT(s.events.periods, IsEmpty());
  EXPECT_THAT(s.events.energies, IsEmpty());
  EXPECT_EQ(s.section.coordinate, "");
  EXPECT_EQ(s.output.flush_seconds, 5.0);
  EXPECT_EQ(s.output.flush_orbits, 5000);
}

TEST(GoodScene, TheGreatestDepthAndSubharmonicsAreTaken) {
  const scene::Scene s = scene::parse("system: {name: double_pendulum}\nstarts: {}\n", "text",
                                      {"survey.depth=16", "survey.subharmonics=16", "limits.time=.inf"});
  EXPECT_EQ(s.survey.depth, 16);
  EXPECT_EQ(s.survey.subharmonics, 16);
  EXPECT_EQ(s.limits.time, infinity);
}

TEST(GoodScene, ASweepMayFindItsRange) {
  const std::string text = "system: {name: double_pendulum}\nstarts: {sweep: {period: auto, step: auto}}\n";
  const scene::Scene automatic = scene::parse(text, "text");
  EXPECT_FALSE(automatic.sweep.period.has_value());
  EXPECT_FALSE(automatic.sweep.step.has_value());
  const scene::Scene fine = scene::parse(text, "text", {"starts.sweep.step=1e-5"});
  EXPECT_FALSE(fine.sweep.period.has_value());
  EXPECT_EQ(fine.sweep.step, 1e-5);
}

TEST(GoodScene, TextIsTheFileWordForWord) {
  EXPECT_EQ(every_key().text, read(source / "tests/scene/good/every_key.yaml"));
}

TEST(SceneFolder, EverySceneLoads) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(source / "drivers/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    EXPECT_NO_THROW(static_cast<void>(scene::load(entry.path()))) << entry.path();
  }
  EXPECT_GE(count, 7);
}

TEST(SceneFolder, TheQuickstartSceneIsTheContracts) {
  const scene::Scene s = scene::load(source / "drivers/scenes/double_pendulum.yaml");
  EXPECT_EQ(s.name, "double-pendulum");
  EXPECT_THAT(s.fixed_points.grid, ElementsAre(ElementsAre(0.0, pi), ElementsAre(0.0, pi)));
  ASSERT_EQ(s.fixed_points.names.size(), 3U);
  EXPECT_THAT(s.fixed_points.names[0].names, ElementsAre("In-Phase", "Out-Phase"));
  EXPECT_THAT(s.fixed_points.letters, ElementsAre(Pair("In-Phase", "I"), Pair("Out-Phase", "O")));
  EXPECT_EQ(s.limits.period, 30.0);
  EXPECT_EQ(s.survey.depth, 2);
  EXPECT_EQ(s.survey.subharmonics, 2);
  EXPECT_EQ(s.section.coordinate, "w1");
  EXPECT_FALSE(s.continuation.fixed_step.has_value());
}

TEST(SceneFolder, HenonHeilesBeginsAtTheOrigin) {
  const scene::Scene s = scene::load(source / "drivers/scenes/henon_heiles.yaml");
  EXPECT_EQ(s.system.name, "henon_heiles");
  EXPECT_THAT(s.fixed_points.grid, ElementsAre(ElementsAre(0.0), ElementsAre(0.0)));
  ASSERT_EQ(s.fixed_points.names.size(), 1U);
  EXPECT_THAT(s.fixed_points.names[0].names, ElementsAre("Straight", "Curved", "Loop"));
  EXPECT_LT(s.sweep.period.value().from, 2 * pi);
  EXPECT_GT(s.sweep.period.value().to, 2 * pi);
  EXPECT_LT(s.limits.energy_to, 1.0 / 6) << "orbits escape above";
  EXPECT_EQ(s.survey.depth, 1);
  EXPECT_EQ(s.survey.subharmonics, 3);
}

TEST(SceneFolder, ThreeBodyScenesNameTheFiveLagrangePoints) {
  for (const auto& [file, mu] :
       {std::pair{"pcr3bp_earth_moon.yaml", 0.01215058560962404}, {"pcr3bp_mu_0.001.yaml", 0.001}}) {
    const scene::Scene s = scene::load(source / "drivers/scenes" / file);
    EXPECT_EQ(s.system.name, "pcr3bp");
    EXPECT_THAT(s.system.parameters, ElementsAre(Pair("mu", mu)));
    ASSERT_EQ(s.fixed_points.names.size(), 5U);
    EXPECT_THAT(s.fixed_points.names[3].point, ElementsAre(testing::DoubleNear(0.5 - mu, 1e-9), testing::_));
    EXPECT_THAT(s.fixed_points.names[3].names, ElementsAre("Long-4", "Short-4"));
    EXPECT_EQ(s.survey.depth, 2);
    EXPECT_EQ(s.survey.subharmonics, 3);
  }
}

TEST(SceneFolder, TheSwingingSpringIsInResonance) {
  const scene::Scene s = scene::load(source / "drivers/scenes/swinging_spring.yaml");
  const auto& p = s.system.parameters;
  EXPECT_EQ(p.at("stiffness") * p.at("length"), 3.0 * p.at("mass") * p.at("gravity"));
  ASSERT_TRUE(s.sweep.period.has_value());
  EXPECT_LT(s.sweep.period->to, 30.0);
}

TEST(SceneFolder, TheDeepAndTheHalfDegreeSceneDifferWhereTheySay) {
  const scene::Scene deep = scene::load(source / "drivers/scenes/double_pendulum_deep.yaml");
  EXPECT_EQ(deep.limits.period, 60.0);
  EXPECT_EQ(deep.survey.depth, 3);
  EXPECT_EQ(deep.survey.subharmonics, 4);
  const scene::Scene half = scene::load(source / "drivers/scenes/double_pendulum_half_degree.yaml");
  ASSERT_TRUE(half.continuation.fixed_step.has_value());
  EXPECT_DOUBLE_EQ(*half.continuation.fixed_step, pi / 360);
  EXPECT_EQ(half.limits.period, 30.0);
}

}  // namespace
}  // namespace good_scenes_test
