// Given orbits that lie on families which the survey follows anyhow are no families of their own.
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "survey/atlas.hpp"

namespace known_families_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// What a survey of the double pendulum from `starts` has found.
class KnownFamilies : public testing::Test {
 protected:
  KnownFamilies() : folder(test::fresh_folder(fmt::format("known{}", comm.size()), comm.get())) {}

  survey::Summary survey_of(const std::string& starts, const std::string& limits) {
    core::on_root(comm.get(), [&] {
      std::ofstream(folder / "scene.yaml") << "system: {name: double_pendulum}\nstarts: {" + starts + "}\nlimits: {" +
                                                  limits + "}\nsurvey: {depth: 0, subharmonics: 1}\n";
    });
    survey::Summary summary = test::run(comm, scene::load(folder / "scene.yaml"), "known_run");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    return summary;
  }

  core::Communicator comm;
  fs::path folder;
};

/// A state of a stored orbit, `part` of its period after its start, as an entry of `starts.states`: `times` around, and
/// the image under S, which turns all signs, for `sign` = -1.
std::string state_of(const test::Atlas& atlas, std::size_t row, double part, int times = 1, double sign = 1.0) {
  const auto system = systems::make_system("double_pendulum");
  const loop::Loop orbit = archive::loop_of(atlas, row, system->structure().angles);
  std::vector<double> state = loop::state_at(orbit, part * orbit.period);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] *= sign * (i < 2 ? 180.0 / std::numbers::pi : 1.0);
  return fmt::format("{{state: [{:.17g}], period: {:.17g}}}", fmt::join(state, ", "), times * orbit.period);
}

/// On rank 0: rows of /orbits of the archive's family, evenly among them.
std::vector<std::size_t> rows_within(const test::Atlas& atlas, const std::string& family, std::size_t count) {
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[atlas.row_of(family)]);
  const auto orbits = static_cast<std::size_t>(atlas.families().integers("orbit_count")[atlas.row_of(family)]);
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < count; ++n) rows.push_back(first + (2 * n + 1) * orbits / (2 * count));
  return rows;
}

const std::string of_origin = "fixed_points: {grid: [[0], [0]], names: {[0, 0]: [In-Phase, Out-Phase]}}";
const std::string oscillations = "period: 24, energy: [-3, -0.5]";  // twice around too

TEST_F(KnownFamilies, OfAnEquilibriumTakeTheStatesThatLieOnThem) {
  const survey::Summary alone = survey_of(of_origin, oscillations);
  std::string states;
  std::vector<double> periods;
  if (comm.is_root()) {
    const test::Atlas atlas(alone.atlas);
    int times = 1;
    for (const std::size_t row : rows_within(atlas, "In-Phase", 3)) {
      states += state_of(atlas, row, 0.3, times, times > 1 ? -1.0 : 1.0) + ", ";
      periods.push_back(atlas.orbits().reals("period")[row]);
      times += times < 2 ? 1 : 0;
    }
  }
  states = core::agreed(comm.get(), states);
  const survey::Summary summary = survey_of(of_origin + ", states: [" + states + "]", oscillations);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.families.size(), alone.families.size());
  EXPECT_EQ(test::dataset_bytes(summary.atlas), test::dataset_bytes(alone.atlas));
  for (std::size_t n = 0; n < periods.size(); ++n)
    EXPECT_THAT(summary.remarks,
                Contains(testing::AllOf(HasSubstr(fmt::format("starts.states, entry {}: ", n + 1)),
                                        HasSubstr(fmt::format("lies on In-Phase, at T = {:.9g}", periods[n])))));
}

// Both sides of the rotations of the outer rod are mirror images.
TEST_F(KnownFamilies, OfAStateTakeTheStatesThatLieOnThem) {
  const std::string outer = "{state: [0, 0, -5.0444829, 9.5780458], period: 0.8211037}";
  const std::string inner = "{state: [0, 0, 8.1215228, -8.3236785], period: 0.9913897}";
  const std::string limits = "energy: [15, 40]";
  const survey::Summary alone = survey_of("states: [" + outer + "]", limits);
  std::vector<std::string> others(2);
  if (comm.is_root()) {
    const test::Atlas atlas(alone.atlas);
    const std::vector<std::size_t> rows = rows_within(atlas, alone.families.front().name, 2);
    others = {state_of(atlas, rows[0], 0.2), state_of(atlas, rows[1], 0.4, 1, -1.0)};
  }
  for (std::string& other : others) other = core::agreed(comm.get(), other);
  const std::string all = "states: [" + outer + ", " + others[0] + ", " + others[1] + ", " + inner + "]";
  const survey::Summary summary = survey_of(all, limits);
  if (!comm.is_root()) return;
  ASSERT_EQ(summary.families.size(), 2U) << "two states of two families are two: "
                                         << testing::PrintToString(summary.remarks);
  EXPECT_THAT(summary.families.back().name, HasSubstr("n(1,0)"));
  const auto on = std::count_if(summary.remarks.begin(), summary.remarks.end(), [&](const std::string& remark) {
    return remark.find("lies on " + summary.families.front().name) != std::string::npos;
  });
  EXPECT_EQ(on, 2) << testing::PrintToString(summary.remarks);
}

}  // namespace
}  // namespace known_families_test
