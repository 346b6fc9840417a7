#include "tasks/branch/branch_events.hpp"

#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/continuation/left_open.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"

namespace branch_events_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;

/// An orbit whose one index is `distance` from 2, and its bound.
spectrum::Stability beside_two(double distance, double bound) {
  spectrum::Stability stability;
  stability.fundamental = {2.0 + distance};
  stability.fundamental_error = {bound};
  return stability;
}

/// A branch of which nothing is known but where it begins.
struct Beginning {
  scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", {});
  BranchWork work = [] {
    BranchWork out;
    out.base = loop::constant_loop(std::vector<double>(4, 0.0), 6.0, 8);
    out.direction = {std::vector<double>(out.base.modes.size(), 1.0), {}};
    return out;
  }();
  FollowedBranch followed{scene, systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects),
                          work, nullptr};
  BranchEvents events{followed, nullptr};
};

// A driven pendulum: the multiplier was still -1500 at the nearest orbit before its meeting that was found.
TEST(BranchEvents, AWayToAMeetingOnWhichNoMultiplierComesToOneIsTold) {
  Beginning branch;
  const BranchWork& work = branch.work;
  FollowedBranch& followed = branch.followed;
  BranchEvents& events = branch.events;
  followed.curve.add(0.0, work.base, kept_orbits);
  followed.curve.add(1.0, loop::moved(work.base, work.direction, 0.1), kept_orbits);
  const auto told = [&](double distance) {
    return events.add_short_of_meeting(events.test_point(1.0, work.base, beside_two(distance, 1e-14)));
  };
  EXPECT_FALSE(told(1e-3));
  EXPECT_TRUE(told(-1500.0));
  ASSERT_EQ(followed.outcome.unlocated.size(), 1U);
  EXPECT_NE(followed.outcome.unlocated.front().find("where no multiplier is near 1"), std::string::npos);
}

// Three oscillators without a symmetry: along a family that ends on one four times around k - 2 was 1.3e-9, 4e-12 and
// -1.8e-14 at the last places before it, the last by more than its bound. Two branch points were stored there.
TEST(BranchEvents, OnTheWayToAMeetingRoundingMakesNoSign) {
  Beginning branch;
  const BranchWork& work = branch.work;
  FollowedBranch& followed = branch.followed;
  BranchEvents& events = branch.events;
  // A small oscillation of the linear equations.
  loop::Loop orbit = work.base;
  orbit.period = 2.0 * std::numbers::pi;
  orbit.cosine(1, 0) = 0.05;
  orbit.sine(1, 2) = -0.05;
  const auto sign_of = [&](int q, double position, const spectrum::Stability& stability) {
    const bifurcation::TestPoint point = events.test_point(position, orbit, stability);
    for (std::size_t f = 0; f < point.readings.size(); ++f)
      if (followed.functions[f].kind == bifurcation::TestFunction::Kind::sector && followed.functions[f].sector.q == q)
        return point.readings[f].sign();
    ADD_FAILURE() << "no function of q = " << q;
    return 0;
  };
  const spectrum::Stability noise = beside_two(-4e-14, 1e-14);
  const spectrum::Stability elliptic = beside_two(-1e-11, 1e-14);
  events.go_to_meeting(1.0, 2.0);
  EXPECT_EQ(sign_of(1, 1.0, noise), -1) << "within the family a value beyond its bound has its sign";
  EXPECT_EQ(sign_of(1, 1.5, noise), 0);
  EXPECT_EQ(sign_of(1, 1.5, elliptic), -1);
  EXPECT_EQ(sign_of(2, 1.5, noise), 1);
  // Lur'e's feedback system, doubled three times: 1.7e-8 of the survey's lengths were left open 8e-8 before a meeting,
  // and a multiplier was 1 + 5e-8 there with a bound of 8e-10. A branch point was stored.
  const double rounding = continuation::left_open_by_rounding(*followed.system, orbit, work.isotropy).across;
  ASSERT_GT(rounding, 0.0);
  events.go_to_meeting(1.0, 1.5 + 3.0 * rounding);
  EXPECT_EQ(sign_of(1, 1.5, elliptic), 0);
  EXPECT_EQ(sign_of(1, 1.5, beside_two(-1e-5, 1e-14)), -1);
}

}  // namespace
}  // namespace branch_events_test
