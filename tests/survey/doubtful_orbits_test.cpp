#include "tasks/payload/doubtful_orbits.hpp"

#include <gmock/gmock.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/scenes.hpp"
#include "survey/tree_outcomes.hpp"
#include "tree/doubt_text.hpp"
#include "tree/family_tree.hpp"

namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using certificate::Verdict;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

DoubtfulOrbits orbits(Verdict verdict, double found, double allowed, double period, int count = 1) {
  return {{verdict, found, allowed, period, 1e251}, count};
}

TEST(DoubtfulOrbits, AreCountedByVerdictWithTheWorst) {
  std::vector<DoubtfulOrbits> all;
  add(all, orbits(Verdict::holds, 1e-12, 1e-4, 7.0));
  EXPECT_TRUE(all.empty());
  add(all, orbits(Verdict::says_nothing, 1e-3, 1e-4, 8.0));
  add(all, orbits(Verdict::drift_contradicts, 1e-3, 1e-8, 9.0));
  add(all, orbits(Verdict::says_nothing, 65.0, 1e-4, 10.0, 2));
  add(all, orbits(Verdict::says_nothing, 2.0, 1e-4, 11.0));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].count, 4);
  EXPECT_EQ(all[0].worst.period, 10.0);
  EXPECT_EQ(all[1].count, 1);
}

TEST(DoubtfulOrbits, AreSaidByVerdict) {
  EXPECT_THAT(doubt_text(orbits(Verdict::says_nothing, 65.0, 1e-4, 10.0, 2)),
              AllOf(StartsWith("the certificates of 2 orbits say nothing: at T = 10 "),
                    HasSubstr("off by 65, as multipliers up to 1e+251 allow")));
  EXPECT_THAT(doubt_text(orbits(Verdict::closure_contradicts, 1e-3, 1e-8, 10.0)),
              AllOf(StartsWith("the certificates of 1 orbit contradict them: at T = 10 "), HasSubstr("explain 1e-08")));
  EXPECT_THAT(doubt_text(orbits(Verdict::drift_contradicts, 1e-3, 1e-8, 10.0)),
              AllOf(StartsWith("the energy changes along 1 orbit: at T = 10 by 0.001"), HasSubstr("does the model")));
}

TEST(DoubtfulOrbits, AreRemarkedOnceAFamily) {
  test::Ended base = test::ended(test::base_work(), continuation::EndReason::period_limit, 5, 12);
  BranchOutcome outcome = unpack_branch_outcome(base.outcome.payload);
  add(outcome.doubtful, orbits(Verdict::says_nothing, 65.0, 1e-4, 10.0, 2));
  base.outcome.payload = pack(outcome);
  const scene::Scene scene = test::quick_scene({});
  FamilyTree tree(scene, systems::make_system("double_pendulum")->structure());
  tree.add(base.task, base.outcome);
  EXPECT_THAT(tree.resolve().remarks,
              Contains(StartsWith("0000.0000 (In-Phase): the certificates of 2 orbits say nothing: ")));
}

}  // namespace
