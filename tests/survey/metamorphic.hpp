#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/moved_system.hpp"
#include "support/turned_system.hpp"
#include "survey/same_tree.hpp"

namespace orbweaver::test {

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
  std::vector<std::string> first;  ///< steps
  /// What the scene says in units so many of which make the plain ones. Lengths of steps are told in the coordinates
  /// with the largest numbers.
  std::function<std::vector<std::string>(double length, double time, double energy)> in_units;
};

/// Of the cases, the first ones are quick.
constexpr std::size_t quick_cases = 5;

inline const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"pendulum",
       "double_pendulum",
       {"system.parameters.m1=1.1", "system.parameters.m2=0.8", "system.parameters.l2=0.9", "survey.depth=2",
        "survey.subharmonics=2", "limits.period=21", "limits.energy=[-.inf, 1.2]", "starts.sweep.period=auto",
        "starts.fixed_points.grid=[[0], [0]]", "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}"},
       exchange({1, 0, 3, 2}),
       {},
       "4deg",
       "2deg",
       "8deg",
       {"0.1deg", "0.25deg", "0.75deg", "1deg", "1.5deg"},
       [](double, double time, double energy) {
         return std::vector{fmt::format("limits.period={}", 21 * time),
                            fmt::format("limits.energy=[-.inf, {}]", 1.2 * energy)};
       }},
      {"triangle",
       "henon_heiles",
       {"survey.subharmonics=4"},
       rotation(2.5),
       {},
       "0.02",
       "0.01",
       "0.04",
       {"0.002", "0.005", "0.01", "0.02", "0.03"},
       [](double, double time, double energy) {
         return std::vector{fmt::format("starts.sweep.period=[{}, {}]", 6 * time, 6.6 * time),
                            fmt::format("starts.sweep.step={}", 0.01 * time),
                            fmt::format("limits.period={}", 30 * time),
                            fmt::format("limits.energy=[-.inf, {}]", 0.15 * energy)};
       }},
      {"earth_moon",
       "pcr3bp_earth_moon",
       {"starts.fixed_points.grid=[[0.488], [0.866]]", "starts.fixed_points.names={}", "starts.fixed_points.letters={}",
        "starts.sweep.period=[6, 7]", "survey.depth=1", "survey.subharmonics=3"},
       exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[0.866], [0.488]]"},
       "0.04",
       "0.02",
       "0.08",
       {"0.002", "0.005", "0.0075", "0.015", "0.02"},
       [](double length, double time, double) {
         return std::vector{fmt::format("starts.fixed_points.grid=[[{}], [{}]]", 0.488 * length, 0.866 * length),
                            fmt::format("starts.sweep.period=[{}, {}]", 6 * time, 7 * time),
                            fmt::format("starts.sweep.step={}", 0.02 * time),
                            fmt::format("continuation.start={}", 0.01 * std::max(length, length / time)),
                            fmt::format("limits.period={}", 30 * time)};
       }},
      {"small_mass",
       "pcr3bp_mu_0.001",
       {"starts.fixed_points.grid=[[-1, 0.499], [-0.866, 0, 0.866]]",
        "starts.fixed_points.names={[-1.0004166666, 0]: [L3], [0.499, 0.8660254038]: [Long-4, L4], "
        "[0.499, -0.8660254038]: [Long-5, L5]}",
        "starts.fixed_points.letters={}", "starts.sweep.period=[6.2, 6.5]", "starts.sweep.step=0.01", "survey.depth=1",
        "survey.subharmonics=1", "limits.energy=[-.inf, -0.88]"},
       exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[-0.866, 0, 0.866], [-1, 0.499]]",
        "starts.fixed_points.names={[0, -1.0004166666]: [L3], [0.8660254038, 0.499]: [Long-4, L4], "
        "[-0.8660254038, 0.499]: [Long-5, L5]}"},
       "0.04",
       "0.02",
       "0.08",
       {"0.0017", "0.0052", "0.0087", "0.0122", "0.0175"},
       [](double length, double time, double energy) {
         const double x = 0.499 * length;
         const double y = 0.8660254038 * length;
         return std::vector{
             fmt::format("starts.fixed_points.grid=[[{}, {}], [{}, 0, {}]]", -length, x, -y, y),
             fmt::format("starts.fixed_points.names={{[{}, 0]: [L3], [{}, {}]: [Long-4, L4], [{}, {}]: [Long-5, L5]}}",
                         -1.0004166666 * length, x, y, x, -y),
             fmt::format("starts.sweep.period=[{}, {}]", 6.2 * time, 6.5 * time),
             fmt::format("starts.sweep.step={}", 0.01 * time),
             fmt::format("continuation.start={}", 0.01 * std::max(length, length / time)),
             fmt::format("limits.period={}", 120 * time),
             fmt::format("limits.energy=[-.inf, {}]", -0.88 * energy)};
       }},
      {"spring",
       "swinging_spring",
       {"survey.subharmonics=2", "limits.energy=[-.inf, 0.5]"},
       exchange({1, 0, 3, 2}),
       {"starts.fixed_points.grid=[[-1.333], [0]]",
        "starts.fixed_points.names={[-1.3333333333, 0]: [Cup, Cap, Bounce]}"},
       "0.04",
       "0.02",
       "0.08",
       {"0.002", "0.005", "0.0075", "0.015", "0.02"},
       [](double length, double time, double energy) {
         const double y = -4.0 / 3.0 * length;
         return std::vector{fmt::format("starts.fixed_points.grid=[[0], [{}]]", y),
                            fmt::format("starts.fixed_points.names={{[0, {}]: [Cup, Cap, Bounce]}}", y),
                            fmt::format("starts.sweep.period=[{}, {}]", 3 * time, 8 * time),
                            fmt::format("starts.sweep.step={}", 0.01 * time),
                            fmt::format("continuation.start={}", 0.01 * std::max(length, length / time)),
                            fmt::format("limits.period={}", 30 * time),
                            fmt::format("limits.energy=[-.inf, {}]", 0.5 * energy)};
       }},
      // With twins that no symmetry tells apart (IBT3-1, IBD), and branches that come back to where another is born.
      {"equal_masses",
       "double_pendulum_deep",
       {"survey.depth=2", "survey.subharmonics=3", "limits.period=33", "limits.energy=[-.inf, 1.35]",
        "starts.sweep.period=[8, 9]", "starts.fixed_points.grid=[[0], [0]]",
        "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}"},
       exchange({1, 0, 3, 2}),
       {},
       "4deg",
       "2deg",
       "8deg",
       {"0.1deg", "0.25deg", "0.75deg", "1deg", "2deg"},
       [](double, double time, double energy) {
         return std::vector{fmt::format("starts.sweep.period=[{}, {}]", 8 * time, 9 * time),
                            fmt::format("starts.sweep.step={}", 0.01 * time),
                            fmt::format("limits.period={}", 33 * time),
                            fmt::format("limits.energy=[-.inf, {}]", 1.35 * energy)};
       }}};
  return all;
}

inline scene::Scene scene_of(const Case& c, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = c.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene::load(fmt::format("{}/drivers/scenes/{}.yaml", ORBWEAVER_SOURCE_DIR, c.file), overrides);
}

/// The tree of a case, on all ranks or on one alone. Told otherwise if there is a system for that.
class Metamorphic : public testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const Case& with() { return cases()[GetParam()]; }

  /// Empty beyond rank 0.
  static std::optional<Atlas> atlas(const core::Communicator& comm, const std::string& name, const scene::Scene& scene,
                                    std::shared_ptr<const systems::System> system = {}) {
    if (!system) system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
    const auto folder = fresh_folder(with().name + name + std::to_string(comm.size()), comm.get());
    const survey::Summary summary = survey::run_survey(comm, scene, system, folder, {});
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    if (!comm.is_root()) return std::nullopt;
    return Atlas(summary.atlas);
  }
  /// Under other overrides.
  std::optional<Atlas> atlas(const std::string& name, const std::vector<std::string>& more) const {
    return atlas(comm, name, scene_of(with(), more));
  }
  static std::shared_ptr<const systems::System> turned(const scene::Scene& scene, const Eigen::MatrixXd& turn,
                                                       double time = 1.0, double energy = 1.0) {
    return moved_system(systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects),
                        systems::AffineMap{turn, Eigen::VectorXd::Zero(turn.rows())}, time, energy);
  }
  core::Communicator comm;
};

inline std::string name_of_case(const testing::TestParamInfo<std::size_t>& at) { return cases()[at.param].name; }

}  // namespace orbweaver::test
