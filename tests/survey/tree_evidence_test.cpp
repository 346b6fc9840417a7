#include "tree/tree_evidence.hpp"

#include <gmock/gmock.h>

#include "support/stated_system.hpp"
#include "survey/scenes.hpp"
#include "survey/tree_outcomes.hpp"
#include "tree/family_tree.hpp"

namespace tree_evidence_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using namespace orbweaver::test;
using continuation::EndReason;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Place p{"0000.0000/000.q4.j1", 8.0, 1.0};
const Place q{"0000.0000/001.q4.j1", 9.0, 2.0};

class Evidence : public ::testing::Test {
 protected:
  TreeEvidence evidence(const std::vector<Ended>& events) {
    FamilyTree tree(scene, test::structure_of("double_pendulum"));
    for (const Ended& event : events) tree.add(event.task, event.outcome);
    return tree.resolve().evidence;
  }
  static Ended base() { return ended(base_work(), EndReason::period_limit, 5, 12); }
  scene::Scene scene = quick_scene({});
};

TEST_F(Evidence, TellsWhatBecameOfEachDirection) {
  const Ended begun = ended(work_from(p, 0), EndReason::period_limit, 16, 30);
  TreeEvidence found = evidence({base(), located(p), begun});
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_EQ(found.crossings[0].crossing, 0);
  EXPECT_EQ(found.crossings[0].directions, 2);
  EXPECT_EQ(found.crossings[0].kernel_dimension, 2);
  EXPECT_THAT(found.crossings[0].sides, ElementsAre(DirectionFate::followed, DirectionFate::unknown));

  found = evidence({base(), located(p), begun, start_failed(work_from(p, 1), "no orbit")});
  EXPECT_THAT(found.crossings[0].sides, ElementsAre(DirectionFate::followed, DirectionFate::failed));
  ASSERT_EQ(found.failures.size(), 1U);
  EXPECT_EQ(found.failures[0].family, p.leaving(1));

  const survey::StartWork start{work_from(p, 1)};
  const Ended beyond{task_of(start), {"start " + start.branch.key, false, "", {}, pack(StartOutcome{}), false}};
  found = evidence({base(), located(p), begun, beyond});
  EXPECT_THAT(found.crossings[0].sides, ElementsAre(DirectionFate::followed, DirectionFate::beyond_limits));
}

TEST_F(Evidence, ADirectionAlongWhichAFamilyArrivedIsFollowed) {
  const TreeEvidence found = evidence(
      {base(), located(p), located(q), arrived(work_from(p, 0), 16, q, 0), arrived(work_from(p, 1), 16, q, 1)});
  ASSERT_EQ(found.crossings.size(), 2U);
  EXPECT_THAT(found.crossings[0].sides, ElementsAre(DirectionFate::followed, DirectionFate::followed));
  EXPECT_THAT(found.crossings[1].sides, ElementsAre(DirectionFate::arrived, DirectionFate::arrived));
  ASSERT_EQ(found.ends.size(), 3U);
  EXPECT_FALSE(found.ends[0].met);
  EXPECT_TRUE(found.ends[1].met && found.ends[1].joined);
  EXPECT_EQ(found.ends[1].crossing, 1);
}

TEST_F(Evidence, FamiliesBeyondTheLimitOfFamiliesAreToldApart) {
  scene.limits.families = 1;
  const TreeEvidence found = evidence({base(), located(p), ended(work_from(p, 0), EndReason::period_limit, 16, 30)});
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_THAT(found.crossings[0].sides, ElementsAre(DirectionFate::beyond_families, DirectionFate::beyond_families));
}

TEST_F(Evidence, AnArrivalAlongNoDirectionNamesTheCrossingsThere) {
  Place elsewhere = q;
  elsewhere.arclength = 2.6;  // period and energy nearly as at q, but another orbit
  Ended stray = arrived(work_from(p, 0), 16, elsewhere, 0);
  BranchOutcome outcome = unpack_branch_outcome(stray.outcome.payload);
  outcome.arrival.front().level = q.energy();
  stray.outcome.payload = pack(outcome);
  TreeEvidence found = evidence({base(), located(p), located(q), stray});
  ASSERT_EQ(found.ends.size(), 2U);
  EXPECT_TRUE(found.ends[1].met);
  EXPECT_FALSE(found.ends[1].joined);
  EXPECT_THAT(found.ends[1].nearby, ElementsAre(1));
  EXPECT_EQ(found.ends[1].level, q.energy());

  found = evidence({base(), located(p), stray});
  EXPECT_THAT(found.ends[1].nearby, IsEmpty());
}

TEST_F(Evidence, AnArrivalAtAnotherOrbitOfThatPeriodAndEnergyNamesNoCrossing) {
  Place elsewhere = q;
  elsewhere.arclength = 2.6;
  const auto nearby_of = [&](double ahead) {
    Ended stray = arrived(work_from(p, 0), 16, elsewhere, 0);
    BranchOutcome outcome = unpack_branch_outcome(stray.outcome.payload);
    outcome.arrival.front().level = q.energy();
    outcome.arrival.front().ahead = ahead;
    stray.outcome.payload = pack(outcome);
    const std::vector<int> first = evidence({base(), located(p), located(q), stray}).ends[1].nearby;
    EXPECT_EQ(evidence({base(), located(p), stray, located(q)}).ends[1].nearby, first) << "whichever comes first";
    return first;
  };
  EXPECT_THAT(nearby_of(0.02), IsEmpty());  // it is 0.2 from the crossing's orbit
  EXPECT_THAT(nearby_of(0.2), ElementsAre(1));
}

TEST_F(Evidence, EventsThatRoundingHidesAreTold) {
  Ended hidden = not_located(p, "");
  hidden.outcome.failed = false;
  LocateOutcome outcome = unpack_locate_outcome(hidden.outcome.payload);
  outcome.undecided = true;
  outcome.remark = "no zero";
  hidden.outcome.payload = pack(outcome);
  const TreeEvidence found = evidence({base(), hidden});
  EXPECT_TRUE(found.failures.empty());
  ASSERT_EQ(found.undecided.size(), 1U);
  EXPECT_EQ(found.undecided[0].family, "0000.0000");
  EXPECT_EQ(found.undecided[0].reason, "event 1: no zero");
}

TEST_F(Evidence, FailedLocationsBelongToTheirFamilies) {
  const TreeEvidence found = evidence({base(), not_located(p, "no root")});
  ASSERT_EQ(found.failures.size(), 1U);
  EXPECT_EQ(found.failures[0].family, "0000.0000");
  EXPECT_EQ(found.failures[0].reason, "event 1: no root");
}

TEST_F(Evidence, WhatABranchHasPassedAndNotFoundIsUndecided) {
  BranchOutcome outcome = unpack_branch_outcome(base().outcome.payload);
  outcome.unlocated = {"two zeros"};
  Ended branch = base();
  branch.outcome.payload = pack(outcome);
  const TreeEvidence found = evidence({branch});
  EXPECT_THAT(found.failures, IsEmpty());
  ASSERT_EQ(found.undecided.size(), 1U);
  EXPECT_EQ(found.undecided[0].family, "0000.0000");
  EXPECT_EQ(found.undecided[0].reason, "two zeros");
}

}  // namespace
}  // namespace tree_evidence_test
