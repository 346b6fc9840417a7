// The same system told otherwise has the same tree: in other coordinates, by other steps. Other units, first steps,
// tolerances, kernels of BLAS and numbers of ranks: the whole matrix, with the label `long`.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/same_tree.hpp"
#include "support/turned_system.hpp"

namespace {

using namespace orbweaver;

/// A scene, the coordinates in which its system may be told otherwise, and what the scene says of them then.
struct Case {
  std::string name;
  std::string file;
  std::vector<std::string> overrides;
  Eigen::MatrixXd turn;
  std::vector<std::string> turned;
  std::string step;  ///< a fixed one
  std::string half;
  std::string twice;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"pendulum",
       "double_pendulum",
       {"system.parameters.m1=1.1", "system.parameters.m2=0.8", "system.parameters.l2=0.9", "survey.depth=2",
        "survey.subharmonics=2", "limits.period=21", "limits.energy=[-.inf, 1.2]", "starts.sweep.period=auto",
        "starts.fixed_points.grid=[[0], [0]]", "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}"},
       test::exchange({1, 0, 3, 2}),
       {},
       "4deg",
       "2deg",
       "8deg"},
      {"triangle",
       "henon_heiles",
       {"survey.subharmonics=4"},
       test::rotation(0.4),
       {},
       "0.02",
       "0.01",
       "0.04"},
      {"earth_moon",
       "pcr3bp_earth_moon",
       {"starts.fixed_points.grid=[[0.488], [0.866]]", "starts.fixed_points.names={}", "starts.fixed_points.letters={}",
        "starts.sweep.period=[6, 7]", "survey.depth=1", "survey.subharmonics=3"},
       test::exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[0.866], [0.488]]"},
       "0.04",
       "0.02",
       "0.08"},
      {"small_mass",
       "pcr3bp_mu_0.001",
       {"starts.fixed_points.grid=[[-1, 0.499], [-0.866, 0, 0.866]]", "starts.fixed_points.names={}",
        "starts.fixed_points.letters={}", "starts.sweep.period=[6.2, 6.5]", "starts.sweep.step=0.01", "survey.depth=1",
        "survey.subharmonics=1", "limits.period=8"},
       test::exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[-0.866, 0, 0.866], [-1, 0.499]]"},
       "0.04",
       "0.02",
       "0.08"},
      {"spring",
       "swinging_spring",
       {"survey.subharmonics=2", "limits.energy=[-.inf, 0.5]"},
       test::exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[-1.333], [0]]", "starts.fixed_points.names={[-1.3333333333, 0]: [Swing, Bounce]}"},
       "0.04",
       "0.02",
       "0.08"}};
  return all;
}

scene::Scene scene_of(const Case& c, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = c.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene::load(fmt::format("{}/drivers/scenes/{}.yaml", ORBWEAVER_SOURCE_DIR, c.file), overrides);
}

class Metamorphic : public testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const Case& with() { return cases()[GetParam()]; }
  /// The tree under other overrides; empty beyond rank 0.
  std::optional<test::Atlas> atlas(const std::string& name, const std::vector<std::string>& more) {
    const survey::Summary summary = test::run(comm, scene_of(with(), more), with().name + name);
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    if (!comm.is_root()) return std::nullopt;
    return test::Atlas(summary.atlas);
  }
  core::Communicator comm;
};

TEST_P(Metamorphic, InOtherCoordinates) {
  const auto plain = atlas("plain", {});
  const scene::Scene scene = scene_of(with(), with().turned);
  const auto system = std::make_shared<const test::TurnedSystem>(
      systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects), with().turn);
  const auto folder = test::fresh_folder(with().name + "turned" + std::to_string(comm.size()), comm.get());
  const survey::Summary summary = survey::run_survey(comm, scene, system, folder, {});
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  if (comm.is_root()) test::expect_same_tree(*plain, test::Atlas(summary.atlas));
}

TEST_P(Metamorphic, ByOtherSteps) {
  const auto plain = atlas("plain", {});
  for (const std::string& step : {with().step, with().half, with().twice}) {
    SCOPED_TRACE(step);
    const auto other = atlas("steps", {"continuation.step=" + step});
    if (comm.is_root()) test::expect_same_tree(*plain, *other);
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, Metamorphic, testing::Range(std::size_t{0}, cases().size()),
                         [](const auto& at) { return cases()[at.param].name; });

}  // namespace
