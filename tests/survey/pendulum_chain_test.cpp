// A chain of four pendulums, eight coordinates: more than every other system of the registry has.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/atlas.hpp"
#include "tasks/locate_task.hpp"
#include "tasks/payload/locate_work.hpp"

namespace pendulum_chain_test {
namespace {

using namespace orbweaver;

constexpr int links = 4;
constexpr double rest = -10.0;

TEST(PendulumChain, ItsNormalModesAreFollowedFromRest) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                                         {"system.parameters.links=4", "limits.energy=[-.inf, -9.5]"});
  const survey::Summary summary = test::run(comm, scene, "chain");
  EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << "no task failed, nothing contradicts";
  ASSERT_EQ(summary.families.size(), 4U);
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.header().state_names.size(), 2U * links);
  EXPECT_EQ(atlas.header().pairs, links - 1);

  // Zeros of 24 L_4(x) = x^4 - 16 x^3 + 72 x^2 - 96 x + 24.
  const std::vector<double> zeros{0.322547689619392312, 1.745761101158346576, 4.536620296921127983,
                                  9.395070912301133129};
  for (int mode = 0; mode < links; ++mode) {
    const std::string family = fmt::format("Equilibrium 1, mode {}", mode + 1);
    const std::vector<double> period = atlas.column("period", family);
    const std::vector<double> energy = atlas.column("energy", family);
    const double linear = 2.0 * std::numbers::pi / std::sqrt(zeros[static_cast<std::size_t>(mode)]);
    ASSERT_GE(period.size(), 3U);
    EXPECT_EQ(atlas.end_of(family), "energy limit (E = -9.5)");
    EXPECT_NEAR(energy.back(), -9.5, 1e-12);
    // T is smooth in E - rest: a line through the first two orbits leads to the linear period at rest.
    const double slope = (period[1] - period[0]) / (energy[1] - energy[0]);
    EXPECT_GT(energy[0], rest);
    EXPECT_LT(energy[0], rest + 1e-3);
    EXPECT_NEAR(period[0] - slope * (energy[0] - rest), linear, 1e-5 * linear) << family;
    EXPECT_GT(std::abs(period[0] - linear), 1e-7 * linear) << family;
  }
}

// Ten links: at E = -54.26 the family turns aside in a gap, beside an index of 2 - 1.3e-5. Steps of 0.005 to 0.02 rad
// go with it whatever else is asked of them, to T = 16.9688692 at E = -53.9; straight across lies T = 16.9699164.
TEST(PendulumChain, ItsFirstModeTurnsAsideWithLongStepsToo) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                  {"starts.sweep.period=[16, 18]", "limits.energy=[-.inf, -53.9]", "continuation.step=0.2rad",
                   "survey.subharmonics=1"});
  const survey::Summary summary = test::run(comm, scene, "aside");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  EXPECT_NEAR(atlas.column("period", "Equilibrium 1, mode 1").back(), 16.9688692, 1e-7);
}

// Mode 2 of ten links: pairs meet, leave the circle and come back within steps. The places are those that steps of 0.02
// rad give too.
TEST(PendulumChain, PairsThatMeetWithinAStepAreFound) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                  {"starts.sweep.period=[7.3, 7.4]", "limits.energy=[-.inf, -54.1]", "survey.subharmonics=1"});
  const survey::Summary summary = test::run(comm, scene, "meeting");
  EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  std::vector<double> periods;
  for (std::size_t n = 0; n < atlas.crossings().rows(); ++n)
    if (atlas.crossings().texts("kind")[n] == "krein") periods.push_back(atlas.crossings().reals("period")[n]);
  std::sort(periods.begin(), periods.end());
  EXPECT_THAT(periods, testing::Pointwise(testing::DoubleNear(1e-8),
                                          {7.447393546, 7.447394146, 7.707613521, 7.707615146, 7.722351003, 7.722546141,
                                           7.735252631, 7.735252850}));
}

// Of sixteen links several short periods nearly are multiples of others: a search for the families along their
// combinations takes most of the time, and nothing that is asked for here depends on it.
TEST(PendulumChain, WhatIsOutsideTheRangeIsNotSearched) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                  {"system.parameters.links=16", "starts.sweep.period=[20.8, 21.6]", "starts.sweep.step=0.05",
                   "survey.subharmonics=1", "limits.steps=1", "limits.energy=[-.inf, .inf]"});
  const survey::Summary summary = test::run(comm, scene, "sixteen");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families.front().name, "Equilibrium 1, mode 1");
  EXPECT_THAT(summary.remarks, testing::Contains(testing::HasSubstr(": Equilibrium 1, mode 2 with T = ")));
  EXPECT_THAT(summary.remarks, testing::Contains(testing::HasSubstr("oscillations with T = ")))
      << "how many families these are, and so their names, is not known";
}

/// Ten links at E = -53.2376: of the family that lies straight across the gap, at rest.
const std::string across =
    "starts={states: [{name: across, period: 16.996141430, state: [10.77996819, 11.84217184, 12.96168485, 14.13436017, "
    "15.35235031, 16.60378679, 17.87401282, 19.15056449, 20.43106018, 21.7393023, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]}]}";

// At E = -53.3005 the two curves of another gap come so near to one another that on the chord between them an index is
// 3e-9 from 2, less than its error bound. Fixed steps of 0.001 rad turn there, and those of 0.01 rad once went across.
TEST(PendulumChain, AFamilyTurnsInAGapWhereItsIndexIsTwoToRounding) {
  const core::Communicator comm;
  for (const std::string limit : {"-53.1", "-53.2"}) {
    SCOPED_TRACE(limit);
    const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml",
                                           {across, "limits.energy=[-53.9, " + limit + "]", "survey.subharmonics=1"});
    const survey::Summary summary = test::run(comm, scene, "turning");
    EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
    if (!comm.is_root()) continue;
    EXPECT_EQ(summary.failures, 0U);
    const test::Atlas atlas(summary.atlas);
    EXPECT_THAT(atlas.crossings().texts("kind"), testing::ElementsAre("fold-period", "fold-energy"));
    for (const double period : atlas.crossings().reals("period")) EXPECT_NEAR(period, 16.99366156, 1e-8);
    for (const double energy : atlas.crossings().reals("energy")) EXPECT_NEAR(energy, -53.30022308, 2e-8);
  }
}

/// Of a task that is never stopped.
class Undisturbed final : public queue::TaskContext {
 public:
  [[nodiscard]] bool report(const queue::Progress& /*progress*/, const queue::StateSource& /*state*/) override {
    return true;
  }
};

// Steps that nobody checks go straight across both gaps. At the second one the index touches 2 as (E - E_0)^2: a pair
// of multipliers passes 1 with a gap below their error bounds.
TEST(PendulumChain, APairThatPassesOneToRoundingIsUndecided) {
  const core::Communicator comm;
  if (!comm.is_root()) return;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/chain.yaml", {});
  const std::shared_ptr<const systems::System> system = systems::make_system("pendulum_chain", {{"links", 10.0}});
  const std::vector<double> hanging(20, 0.0);
  const starts::Oscillation mode = starts::linear_modes(*system, hanging).oscillations.front();
  continuation::Start start;
  start.base = loop::constant_loop(hanging, mode.period, 10);
  start.direction.modes.assign(start.base.modes.size(), 0.0);
  const std::complex<double> phase = mode.kernel(0, 0) / std::abs(mode.kernel(0, 0));
  for (std::size_t i = 0; i < hanging.size(); ++i) {
    const std::complex<double> entry = mode.kernel(static_cast<Eigen::Index>(i), 0) / phase;
    start.direction.modes[hanging.size() + i] = entry.real();       // cos s
    start.direction.modes[2 * hanging.size() + i] = -entry.imag();  // sin s
  }
  const systems::Structure& structure = system->structure();
  start.isotropy = {{"S", false, structure.equivariances[0].map, 1, 2}, {"R", true, structure.reversors[0].map, 0, 1}};
  continuation::Options options;
  options.energy_to = -53.1;
  survey::LocateWork work;
  work.isotropy = start.isotropy;
  work.event = {bifurcation::Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {1, 0}}, true};
  (void)continuation::trace(system, start, options, [&](const continuation::Orbit& orbit) {
    work.known.push_back({orbit.arclength, orbit.loop});
    return true;
  });
  ASSERT_GT(work.known.size(), 3U);
  EXPECT_GT(work.known.back().loop.period, 16.996) << "straight across";
  work.from = work.known[work.known.size() - 3].position;
  work.to = work.known.back().position;
  Undisturbed context;
  const queue::TaskOutcome outcome = survey::locate(scene, system, work, context, nullptr);
  ASSERT_FALSE(outcome.failed) << outcome.reason;
  const survey::LocateOutcome crossing = survey::unpack_locate_outcome(outcome.payload);
  EXPECT_TRUE(crossing.undecided);
  EXPECT_FALSE(crossing.kind.has_value()) << "none is listed that is not told from none";
  EXPECT_NEAR(crossing.period, 16.99365, 1e-5);
  EXPECT_THAT(crossing.remark, testing::HasSubstr("of 2 directions being flat"));
}

}  // namespace
}  // namespace pendulum_chain_test
