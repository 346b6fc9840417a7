#include "tasks/branch/branch_events.hpp"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
    return events.add_short_of_meeting(followed.test_point(1.0, beside_two(distance, 1e-14)));
  };
  EXPECT_FALSE(told(1e-3));
  EXPECT_TRUE(told(-1500.0));
  ASSERT_EQ(followed.outcome.unlocated.size(), 1U);
  EXPECT_NE(followed.outcome.unlocated.front().find("where no multiplier is near 1"), std::string::npos);
}

}  // namespace
}  // namespace branch_events_test
