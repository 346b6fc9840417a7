// Surveys that start from what a scene gives: orbits of another archive, loops in CSV, returns of a trajectory.
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "survey/atlas.hpp"
#include "survey/widened.hpp"

namespace given_starts_test {
namespace {

using namespace orbweaver;
using testing::HasSubstr;
namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// Written on rank 0, read on all; not before all have read the one before.
scene::Scene scene_in(const core::Communicator& comm, const fs::path& folder, const std::string& starts,
                      const std::string& more = "") {
  MPI_Barrier(comm.get());
  core::on_root(comm.get(), [&] {
    write(folder / "scene.yaml", "system: {name: double_pendulum" + more + "}\nstarts: {" + starts +
                                     "}\nlimits: {period: 8, energy: [-3, 3]}\nsurvey: {depth: 0, subharmonics: 1}\n");
  });
  return scene::load(folder / "scene.yaml");
}

std::string table(const loop::Loop& loop) {
  std::string text = "w1,w2,t,th2,th1\n";
  for (int n = 0; n < 60; ++n) {
    const double time = loop.period * (n + 0.3 * std::sin(n)) / 60.0;
    const std::vector<double> z = loop::state_at(loop, time);
    text += fmt::format("{},{},{},{},{}\n", z[2], z[3], 10.0 + time, z[1], z[0]);
  }
  return text;
}

class GivenStarts : public testing::Test {
 protected:
  GivenStarts() : folder(test::fresh_folder(fmt::format("given{}", comm.size()), comm.get())) {
    const survey::Summary made =
        test::run(comm, test::quick_scene({"limits.period=6", "survey.subharmonics=1"}), "source");
    core::on_root(comm.get(), [&] { fs::copy_file(made.atlas, folder / "source.h5"); });
  }
  [[nodiscard]] std::string refusal(const std::string& starts, const std::string& more = "") {
    try {
      const scene::Scene scene = scene_in(comm, folder, starts, more);
      static_cast<void>(survey::expected_starts(scene, *scene::bound_system(scene.system)));
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  core::Communicator comm;
  fs::path folder;
};

TEST_F(GivenStarts, FromAnOrbitAndFromItsLoopLeadToItsFamilyOnce) {
  const test::Atlas source(folder / "source.h5");
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> periods = source.column("period", "Down-Up");
  const auto first = static_cast<std::size_t>(source.families().integers("first_orbit")[source.row_of("Down-Up")]);
  const std::size_t at = periods.size() / 2;
  const loop::Loop orbit = archive::loop_of(source, first + at, system->structure().angles);
  core::on_root(comm.get(), [&] { write(folder / "loop.csv", table(orbit)); });
  const std::string loop = fmt::format("loops: [{{file: loop.csv, period: {}}}]", orbit.period);
  const std::string near =
      fmt::format("orbits: [{{archive: source.h5, family: Down-Up, near: {{period: {}}}}}]", orbit.period + 1e-4);
  std::set<std::string> names;
  for (const std::string& starts : {loop, near, near + ", " + loop}) {
    SCOPED_TRACE(starts);
    const survey::Summary summary = test::run(comm, scene_in(comm, folder, starts), "led");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    ASSERT_EQ(summary.families.size(), 1U);
    names.insert(summary.families.front().name);
    const test::Atlas atlas(summary.atlas);
    const auto& steps = atlas.orbits().integers("step");
    const auto row = static_cast<std::size_t>(std::find(steps.begin(), steps.end(), 0) - steps.begin());
    EXPECT_NEAR(atlas.orbits().reals("period")[row], orbit.period, 1e-12);
    EXPECT_NEAR(atlas.orbits().reals("energy")[row], source.orbits().reals("energy")[first + at], 1e-9);
    EXPECT_EQ(steps.front() < 0 && steps.back() > 0, true) << "it runs to both sides";
  }
  if (!comm.is_root()) return;
  EXPECT_EQ(names.size(), 1U) << "one orbit has one name: " << testing::PrintToString(names);
}

TEST_F(GivenStarts, FromAnOrbitWithOtherParametersAreGuesses) {
  const survey::Summary summary = test::run(
      comm,
      scene_in(comm, folder, "orbits: [{archive: source.h5, family: Out-Phase, near: {step: 12}, name: Heavier}]",
               ", parameters: {m2: 1.05}"),
      "heavier");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families.front().name, "Heavier");
}

TEST_F(GivenStarts, FromArchivesThatDoNotFitAreRefused) {
  const std::string near = "near: {energy: -1}}]";
  EXPECT_THAT(refusal("orbits: [{archive: source.h5, family: Sideways, " + near),
              HasSubstr("starts.orbits, entry 1: expected a family of"));
  EXPECT_THAT(refusal("orbits: [{archive: source.h5, family: Out-Phase, " + near, ", effects: [rod_inertia]"),
              HasSubstr("expected an archive of double_pendulum with rod_inertia, got one of double_pendulum"));
  EXPECT_EQ(refusal("orbits: [{archive: source.h5, family: Out-Phase, " + near), "accepted");
  // A byte of a stored period: its row no longer gives its checksum.
  const double period = test::Atlas(folder / "source.h5").orbits().reals("period")[3];
  core::on_root(comm.get(), [&] {
    std::ifstream stream(folder / "source.h5", std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const std::string_view sought(reinterpret_cast<const char*>(&period), sizeof period);
    const std::size_t place = bytes.find(sought);
    ASSERT_NE(place, std::string::npos);
    bytes[place] ^= 1;
    write(folder / "damaged.h5", bytes);
  });
  EXPECT_THAT(refusal("orbits: [{archive: damaged.h5, family: Out-Phase, " + near), HasSubstr("changed row"));
}

TEST(StartsOfStates, NoStartAtAllIsRefusedWithTheKeysToGive) {
  const core::Communicator comm;
  const fs::path folder = test::fresh_folder(fmt::format("no_start{}", comm.size()), comm.get());
  const scene::Scene scene = scene_in(comm, folder, "");
  try {
    static_cast<void>(survey::expected_starts(scene, *scene::bound_system(scene.system)));
    ADD_FAILURE() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("give starts.fixed_points.grid"), HasSubstr("starts.states")));
  }
}

// In the order of winding, period and energy, with names that say so, in whatever order the scene gives them.
TEST(StartsOfStates, AreNumberedByWhatTheyAre) {
  const core::Communicator comm;
  const fs::path folder = test::fresh_folder(fmt::format("numbered{}", comm.size()), comm.get());
  const std::string outer = "{state: [0, 0, -5.0444829, 9.5780458], period: 0.8211037}";
  const std::string inner = "{state: [0, 0, 8.1215228, -8.3236785], period: 0.9913897}";
  const std::string both = "{state: [0, 180, 7.8737448, 7.8093862], period: 0.8114095}";
  std::vector<std::map<std::string, std::string>> bytes;
  for (const std::string& order : {outer + ", " + inner + ", " + both, both + ", " + outer + ", " + inner}) {
    MPI_Barrier(comm.get());  // all have read the scene before
    core::on_root(comm.get(), [&] {
      write(folder / "scene.yaml", "system: {name: double_pendulum}\nstarts: {states: [" + order +
                                       "]}\nlimits: {energy: [15, 40]}\nsurvey: {depth: 0, subharmonics: 1}\n");
    });
    const survey::Summary summary = test::run(comm, scene::load(folder / "scene.yaml"), "numbered_run");
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    ASSERT_EQ(summary.families.size(), 3U);
    EXPECT_EQ(summary.families[0].name, "Orbit n(0,1) T=0.821104 E=20");
    EXPECT_EQ(summary.families[1].name, "Orbit n(1,0) T=0.99139 E=30");
    EXPECT_EQ(summary.families[2].name, "Orbit n(1,1) T=0.81141 E=30");
    EXPECT_EQ(summary.families[0].key, "0000.0000");
    bytes.push_back(test::dataset_bytes(summary.atlas));
  }
  if (comm.is_root()) {
    ASSERT_EQ(bytes.size(), 2U);
    EXPECT_EQ(bytes[0], bytes[1]);
  }
}

TEST(StartsOfStates, BeyondTheLimitsAreLeftOutAndBegunByWiderOnes) {
  const core::Communicator comm;
  const fs::path folder = test::fresh_folder(fmt::format("left_out{}", comm.size()), comm.get());
  core::on_root(comm.get(), [&] {
    write(folder / "scene.yaml",
          "system: {name: double_pendulum}\nstarts: {states: [{state: [0, 0, -5.0444829, 9.5780458], period: "
          "0.8211037}]}\n"
          "limits: {energy: [19, 21]}\nsurvey: {depth: 0, subharmonics: 1}\n");
  });
  const auto scene_with = [&](const std::vector<std::string>& limits) {
    return scene::load(folder / "scene.yaml", limits);
  };
  for (const std::string limit : {"limits.energy=[20.5, 21]", "limits.period=0.8"}) {
    SCOPED_TRACE(limit);
    test::expect_same_when_widened(comm, scene_with, {limit});
  }
}

// 51 returns of the shipped scene's trajectory within T = 2000; here the first part of it.
TEST(StartsOfRecurrences, LeadToOrbitsOfTheTrajectorysEnergyOnce) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/recurrences.yaml",
                  {"starts.recurrences.time=600", "starts.recurrences.tolerance=0.2", "starts.recurrences.most=4"});
  const survey::Summary summary = test::run(comm, scene, "returns");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  ASSERT_EQ(summary.families.size(), 4U) << testing::PrintToString(summary.remarks);
  const test::Atlas atlas(summary.atlas);
  const auto system = systems::make_system("double_pendulum");
  std::vector<double> periods;
  for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
    if (atlas.orbits().integers("step")[row] != 0) continue;
    EXPECT_NEAR(atlas.orbits().reals("energy")[row], 0.0, 1e-9);
    periods.push_back(atlas.orbits().reals("period")[row]);
  }
  EXPECT_EQ(periods.size(), 4U);
  EXPECT_EQ(std::set<double>(periods.begin(), periods.end()).size(), 4U);
  EXPECT_THAT(summary.remarks.front(), HasSubstr("returns"));
}

}  // namespace
}  // namespace given_starts_test
