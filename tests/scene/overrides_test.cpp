#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/scene.hpp"

namespace overrides_test {
namespace {

namespace scene = orbweaver::scene;
using testing::ElementsAre;

const std::string base = "# a comment\nsystem: {name: double_pendulum}\nstarts: {}\nlimits: {period: 30, steps: 10}\n";

scene::Scene with(const std::vector<std::string>& overrides, const std::string& text = base) {
  return scene::parse(text, "base.yaml", overrides);
}

std::string message(const std::vector<std::string>& overrides, const std::string& text = base) {
  try {
    static_cast<void>(with(overrides, text));
  } catch (const orbweaver::core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Overrides, ReplaceAValueAndLeaveItsNeighbours) {
  const scene::Scene s = with({"limits.period=12.5"});
  EXPECT_EQ(s.limits.period, 12.5);
  EXPECT_EQ(s.limits.steps, 10);
}

TEST(Overrides, CreateMissingMaps) {
  const scene::Scene s = with({"survey.depth=2", "starts.sweep.period=[1,8]", "continuation.step=0.01rad"});
  EXPECT_EQ(s.survey.depth, 2);
  EXPECT_EQ(s.sweep.period.value().to, 8.0);
  EXPECT_EQ(s.continuation.fixed_step, 0.01);
}

TEST(Overrides, TheLastOneWins) { EXPECT_EQ(with({"limits.period=3", "limits.period=4"}).limits.period, 4.0); }

TEST(Overrides, TakeMapsWithListsAsKeys) {
  const scene::Scene s =
      with({"starts.fixed_points.names={[0, 0]: [In-Phase]}", "starts.fixed_points.letters.In-Phase=I"});
  ASSERT_EQ(s.fixed_points.names.size(), 1U);
  EXPECT_THAT(s.fixed_points.names[0].names, ElementsAre("In-Phase"));
  EXPECT_EQ(s.fixed_points.letters.at("In-Phase"), "I");
}

TEST(Overrides, DoNotTravelThroughAnchors) {
  const std::string text = base + "events: {periods: &p [10], energies: *p}\n";
  const scene::Scene s = with({"events.periods=[20]"}, text);
  EXPECT_THAT(s.events.periods, ElementsAre(20.0));
  EXPECT_THAT(s.events.energies, ElementsAre(10.0));
}

TEST(Overrides, MendWhatTheFileHasWrong) {
  EXPECT_EQ(
      with({"limits.period=3"}, "system: {name: double_pendulum}\nstarts: {}\nlimits: {period: -1}\n").limits.period,
      3.0);
}

TEST(Overrides, TextHoldsThemAndReadsBackTheSame) {
  const auto file = std::filesystem::path(ORBWEAVER_SOURCE_DIR) / "tests/scene/good/every_key.yaml";
  const scene::Scene s = scene::load(file, {"limits.period=17.25", "events.periods=[1, 2]", "name=\"30\""});
  const scene::Scene again = scene::parse(s.text, "again");
  EXPECT_EQ(again.limits.period, 17.25);
  EXPECT_EQ(again.name, "30");
  EXPECT_THAT(again.events.periods, ElementsAre(1.0, 2.0));
  EXPECT_EQ(again.system.parameters, s.system.parameters);
  EXPECT_EQ(again.fixed_points.grid, s.fixed_points.grid);
  ASSERT_EQ(again.fixed_points.names.size(), 2U);
  EXPECT_EQ(again.fixed_points.names[0].point, s.fixed_points.names[0].point);
  EXPECT_EQ(again.fixed_points.names[0].names, s.fixed_points.names[0].names);
  EXPECT_EQ(again.fixed_points.letters, s.fixed_points.letters);
  EXPECT_EQ(again.continuation.fixed_step, s.continuation.fixed_step);
  EXPECT_EQ(again.limits.energy_from, s.limits.energy_from);
  EXPECT_EQ(again.section.coordinate, s.section.coordinate);
}

TEST(OverrideErrors, NameTheOverride) {
  EXPECT_EQ(message({"limits.perid=3"}),
            "--set limits.perid=3: limits.perid: unknown key, expected one of period, energy, parameter, guards, "
            "families, steps, time or task_time, got `perid`; did you mean `period`?");
  EXPECT_EQ(message({"limits.period=-3"}),
            "--set limits.period=-3: limits.period: expected a number > 0 or infinite, got `-3`; for example 30");
  EXPECT_EQ(message({"limits.period="}),
            "--set limits.period=: limits.period: expected a number > 0 or infinite, got nothing; for example 30");
  EXPECT_EQ(
      message({"starts.sweep.period=[1, x]"}),
      "--set starts.sweep.period=[1, x]: starts.sweep.period[1]: expected a number > 0, got `x`; for example [1, 12]");
  EXPECT_EQ(message({"system.parameters.m1=0"}),
            "--set system.parameters.m1=0: system.parameters.m1: expected a number > 0, got `0`; for example 1");
}

TEST(OverrideErrors, NameTheLastOfSeveral) {
  EXPECT_EQ(message({"limits.period=-1", "limits.period=-2"}).find("--set limits.period=-2: "), 0U);
}

TEST(OverrideErrors, NameTheFileWhereTheFileIsWrong) {
  EXPECT_EQ(message({"limits.period=3"}, "system: {name: double_pendulum}\nstarts: {}\nlimits: {steps: 0}\n"),
            "base.yaml:3: limits.steps: expected an integer >= 1, got `0`; for example 5000");
}

TEST(OverrideErrors, NameTheOverrideThatMadeAMapWithoutWhatItNeeds) {
  EXPECT_EQ(
      message({"section.value=1"}),
      "--set section.value=1: section: expected the section's `coordinate`, got a section without it; name one of the "
      "system's coordinates");
}

TEST(OverrideErrors, APathThroughAScalarIsRefused) {
  EXPECT_EQ(message({"limits.period.long=3"}),
            "--set limits.period.long=3: expected a map at `limits.period`, got `30`; set the whole value instead");
}

TEST(OverrideErrors, MustHaveAKeyAndAValue) {
  for (const std::string words : {"limits.period", "=3", "limits.=3", ".limits=3", "limits..period=3", ""})
    EXPECT_EQ(message({words}),
              "--set " + words + ": expected KEY=VALUE, got `" + words + "`; for example --set limits.period=30");
}

TEST(OverrideErrors, BadYamlIsRefused) {
  EXPECT_EQ(message({"starts.sweep.period=[1"}),
            "--set starts.sweep.period=[1: expected YAML, got a syntax error (end of sequence flow not found); check "
            "brackets, colons and indentation, which takes spaces and no tabs");
}

TEST(OverrideErrors, DoNotFillAnEmptyScene) {
  EXPECT_EQ(message({"limits.period=3"}, "").find("base.yaml:1: expected a scene, a map, got an empty document"), 0U);
}

}  // namespace
}  // namespace overrides_test
