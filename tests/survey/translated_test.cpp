// About another origin, where all symmetries are affine, a survey finds the same tree.
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"
#include "support/moved_system.hpp"
#include "survey/atlas.hpp"

namespace translated_test {
namespace {

using namespace orbweaver;
using test::Atlas;

struct Pair {
  survey::Summary here;
  survey::Summary there;
};

Pair surveys(const core::Communicator& comm, const std::string& name, const scene::Scene& here,
             const scene::Scene& there, const Eigen::VectorXd& offset) {
  const auto system = systems::make_system(here.system.name, here.system.parameters, here.system.effects);
  const auto moved = test::translated_system(system, offset);
  Pair out;
  out.here = test::run(comm, here, name);
  const auto folder = test::fresh_folder(name + "_moved" + std::to_string(comm.size()), comm.get());
  out.there = survey::run_survey(comm, there, moved, folder, {});
  return out;
}

void expect_same(const Pair& pair) {
  EXPECT_EQ(pair.here.failures, 0U);
  EXPECT_EQ(pair.there.failures, 0U) << (pair.there.failed_tasks.empty() ? "" : pair.there.failed_tasks.front());
  std::map<std::string, survey::FamilySummary> expected;
  for (const survey::FamilySummary& family : pair.here.families) expected.emplace(family.name, family);
  ASSERT_EQ(pair.there.families.size(), expected.size());
  for (const survey::FamilySummary& found : pair.there.families) {
    SCOPED_TRACE(found.name);
    ASSERT_TRUE(expected.contains(found.name));
    const survey::FamilySummary& family = expected.at(found.name);
    EXPECT_EQ(found.isotropy, family.isotropy);
    EXPECT_EQ(found.depth, family.depth);
    EXPECT_NEAR(found.period_to, family.period_to, 1e-7);
    EXPECT_NEAR(found.level_to, family.level_to, 1e-7);
  }
  const Atlas here(pair.here.atlas);
  const Atlas there(pair.there.atlas);
  ASSERT_EQ(there.crossings().rows(), here.crossings().rows());
  EXPECT_GT(here.crossings().rows(), 0U);
  for (std::size_t row = 0; row < here.crossings().rows(); ++row) {
    const auto owner = static_cast<std::size_t>(here.crossings().integers("family")[row]);
    const std::string& family = here.families().texts("name")[owner];
    const auto found =
        there.crossing(family, here.crossings().texts("kind")[row], here.crossings().reals("period")[row]);
    ASSERT_TRUE(found.has_value()) << family << ", T = " << here.crossings().reals("period")[row];
    EXPECT_NEAR(there.crossings().reals("period")[*found], here.crossings().reals("period")[row], 1e-8) << family;
    EXPECT_EQ(there.born_at(*found), here.born_at(row)) << family;
  }
}

TEST(Translated, HenonHeiles) {
  const core::Communicator comm;
  const std::string file = ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml";
  const std::string sweep = "starts.sweep.step=0.05";
  const std::string shallow = "survey.subharmonics=2";
  // About coordinates of 7 rounding of the residual is above the default of 1e-10 times the speed.
  const std::string coarse = "continuation.tolerance=1e-9";
  const Pair pair =
      surveys(comm, "triangle", scene::load(file, {sweep, shallow, coarse}),
              scene::load(file, {sweep, shallow, coarse, "starts.fixed_points.grid=[[3], [-7], [0.5], [1.25]]",
                                 "starts.fixed_points.names={[3, -7, 0.5, 1.25]: [Straight, Curved, Loop]}"}),
              Eigen::Vector4d(3.0, -7.0, 0.5, 1.25));
  if (comm.is_root()) expect_same(pair);
}

// First orbits 0.003 from the equilibrium, where the mean of |z| is 1e5: orbits are told apart by their motion.
TEST(Translated, FarFromTheOriginFamiliesAreNotTakenForOneAnother) {
  const core::Communicator comm;
  const std::string file = ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml";
  const std::vector<std::string> near{"continuation.start=0.003"};
  std::vector<std::string> far = near;
  far.emplace_back("starts.fixed_points.grid=[[100000], [100000], [0], [0]]");
  far.emplace_back("starts.fixed_points.names={[100000, 100000, 0, 0]: [Straight, Curved, Loop]}");
  const Pair pair =
      surveys(comm, "far", scene::load(file, near), scene::load(file, far), Eigen::Vector4d(1e5, 1e5, 0.0, 0.0));
  if (!comm.is_root()) return;
  EXPECT_EQ(pair.here.failures, 0U);
  EXPECT_EQ(pair.there.failures, 0U) << "contradictions too";
  EXPECT_EQ(pair.there.families.size(), pair.here.families.size());
}

// Angles: the mirror S maps th to 60 deg - th and 270 deg - th, modulo whole turns.
TEST(Translated, DoublePendulum) {
  const core::Communicator comm;
  const std::vector<std::string> both{"survey.depth=1", "survey.subharmonics=2", "limits.period=11"};
  std::vector<std::string> moved = both;
  moved.emplace_back("starts.fixed_points.grid=[[30, 210], [135, 315]]");
  moved.emplace_back(
      "starts.fixed_points.names={[30, 135]: [In-Phase, Out-Phase], [30, 315]: [Down-Up], [210, 135]: [Up-Down]}");
  const double degree = std::numbers::pi / 180.0;
  const Pair pair = surveys(comm, "turned", test::quick_scene(both), test::quick_scene(moved),
                            Eigen::Vector4d(30.0 * degree, 135.0 * degree, 0.0, 0.0));
  if (comm.is_root()) expect_same(pair);
}

// A model that no longer is what its structure says, since the survey was begun.
class Changed final : public test::DelegatingSystem {
 public:
  explicit Changed(std::shared_ptr<const systems::System> system)
      : DelegatingSystem(std::move(system)), _structure(whole().structure()) {
    std::swap(_structure.reversors, _structure.equivariances);
  }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }

 private:
  systems::Structure _structure;
};

TEST(Resumed, AWrongModelIsRefused) {
  const core::Communicator comm;
  const scene::Scene scene = test::quick_scene({"limits.period=20", "continuation.step=0.3deg", "limits.steps=2000"});
  const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  const auto folder = test::fresh_folder("changed" + std::to_string(comm.size()), comm.get());
  survey::RunOptions options;
  options.walltime = 0.0;
  ASSERT_TRUE(survey::run_survey(comm, scene, system, folder, options).stopped_early);
  options = {};
  options.resume = true;
  EXPECT_THROW((void)survey::run_survey(comm, scene, std::make_shared<const Changed>(system), folder, options),
               core::InputError);
  EXPECT_EQ(survey::run_survey(comm, scene, system, folder, options).failures, 0U);
}

}  // namespace
}  // namespace translated_test
