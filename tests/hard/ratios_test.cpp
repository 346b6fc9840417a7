// Masses and lengths in ratios 1e-6 to 1e6 and gravity 1e-6 to 1e6, against the simple pendulum that the slow swing of
// the double one becomes in each limit.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "survey/atlas.hpp"

namespace ratios_test {
namespace {

using namespace orbweaver;

using test::reference::Real;

struct Limit {
  std::string name;
  std::vector<std::string> parameters;
  std::string becomes;
  double length;  ///< of the simple pendulum
  double weight;  ///< its mass times gravity
  /// Corrections are of first order in the small ratio; with gravity alone there are none.
  double bound;
  std::vector<std::string> overrides{};
};

class Ratios : public testing::TestWithParam<Limit> {};

// The slow family at the energy of a simple pendulum that swings to 1 rad.
TEST_P(Ratios, TheSlowSwingIsThatOfASimplePendulum) {
  const Limit& with = GetParam();
  const std::string name = "In-Phase, " + fmt::format("{}", fmt::join(with.parameters, ", "));
  const Real reach = 1;
  const double energy = static_cast<double>(-with.weight * with.length * std::cos(reach));
  test::HardCase row(name, with.becomes + ", swings to 1 rad: T, relative");
  const core::Communicator comm;
  std::vector<std::string> overrides{"starts.sweep={}",
                                     "starts.fixed_points.grid=[[0], [0]]",
                                     "starts.fixed_points.names={[0, 0]: [In-Phase, Out-Phase]}",
                                     "survey.depth=0",
                                     "survey.subharmonics=1",
                                     "limits.families=1",
                                     "limits.period=.inf",
                                     fmt::format("limits.energy=[-.inf, {:.17g}]", energy)};
  overrides.insert(overrides.end(), with.overrides.begin(), with.overrides.end());
  for (const std::string& parameter : with.parameters) overrides.push_back("system.parameters." + parameter);
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml", overrides);
  const survey::Summary summary = test::run(comm, scene, "ratio");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.end_of("In-Phase").substr(0, 12), "energy limit");
  const double period = atlas.column("period", "In-Phase").back();
  const double gravity = scene.system.parameters.at("g");
  const auto exact = static_cast<double>(4 * test::reference::pendulum_quarter(test::reference::pi - reach) *
                                         std::sqrt(Real(with.length) / Real(gravity)));
  row.within(std::abs(period / exact - 1.0), with.bound);
}

std::string name_of(const testing::TestParamInfo<Limit>& tested) { return tested.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Hard, Ratios,
    testing::Values(Limit{"light_outer", {"m2=1e-6", "l2=0.3"}, "the inner bob alone", 1.0, 1.0, 1e-5},
                    Limit{"light_inner", {"m1=1e-6"}, "both rods in line", 2.0, 1.0, 1e-5},
                    Limit{"heavy_outer", {"m2=1e6"}, "both rods in line", 2.0, 1e6, 1e-5},
                    Limit{"strong_gravity", {"m1=1e-6", "g=1e6"}, "both rods in line", 2.0, 1e6, 1e-5},
                    Limit{"weak_gravity", {"m1=1e-6", "g=1e-6"}, "both rods in line", 2.0, 1e-6, 1e-5}),
    name_of);
// Beside the slow swing the outer bob turns a thousand times as fast: from one orbit to the next its phase gains six
// turns, and the multipliers say nothing that can be followed (docs/accuracy.md, "Hard cases").
INSTANTIATE_TEST_SUITE_P(
    WithoutMultipliers, Ratios,
    testing::Values(Limit{
        "short_outer", {"l2=1e-6"}, "both bobs at one place", 1.0, 2.0, 1e-5, {"compute.stability=false"}}),
    name_of);

}  // namespace
}  // namespace ratios_test
