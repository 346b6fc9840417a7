#include <gmock/gmock.h>

#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"
#include "survey/scenes.hpp"
#include "survey/tree_outcomes.hpp"
#include "tasks/recorders.hpp"
#include "tree/family_tree.hpp"

namespace tree_rounds_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using continuation::EndReason;
using namespace orbweaver::test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Place o{"0000.0000/000.q3.j1", 7.5, 0.7};
const Place p{"0000.0000/000.q4.j1", 8.0, 1.0};
const Place q{"0000.0000/001.q4.j1", 9.0, 2.0};
const Place r{"0000.0000/002.q4.j1", 9.5, 2.5};

class TreeRounds : public ::testing::Test {
 protected:
  void add(const std::vector<Ended>& events) {
    for (const Ended& event : events) tree.add(event.task, event.outcome);
  }
  [[nodiscard]] std::vector<std::string> keys() const {
    std::vector<std::string> out;
    for (const archive::FamilyRecord& family : tree.resolve().tables.families) out.push_back(family.key);
    return out;
  }

  scene::Scene scene = quick_scene({});
  FamilyTree tree{scene, test::structure_of("double_pendulum")};
};

// P's family ends at Q, where Q's is the same from the other end. Both have a crossing at one place of theirs, a family
// born there, and R's family arrives at that place: at the crossing on Q's family, as far as the loops can tell. That
// one is dropped with its family, so R's arrives at the crossing on P's, and what was born there is R's from the other
// end.
TEST_F(TreeRounds, AnArrivalAtACrossingThatIsDroppedCountsAtTheNextBest) {
  const Place on_p{p.leaving(0) + "/000.q2.j1", 17.0, 6.0, 1, p.leaving(0), 1};
  const Place on_q{q.leaving(0) + "/000.q2.j1", 17.0, 6.0002, 1, q.leaving(0), 1};
  add({ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q), located(r),
       arrived(work_from(p, 0), 16, q, 0), ended(work_from(q, 0), EndReason::period_limit, 18, 20), located(on_p, 1),
       located(on_q, 1), ended(work_from(on_p, 0), EndReason::period_limit, 17, 30),
       ended(work_from(on_q, 0), EndReason::period_limit, 17, 30), arrived(work_from(r, 0), 19, on_q, 0)});
  EXPECT_THAT(keys(), ElementsAre("0000.0000", p.leaving(0), r.leaving(0)));
  EXPECT_THAT(tree.resolve().tables.left_out_keys, ElementsAre(on_p.leaving(0), q.leaving(0), on_q.leaving(0)));
}

TEST_F(TreeRounds, WhatWasLeftOutIsAskedAgainWhenMoreIsKnown) {
  queue::Observer display;
  CheckpointKeeper keeper("nowhere", {});
  const core::Communicator alone(MPI_COMM_SELF);
  const archive::Header header;
  archive::Records rows;
  PayloadStore store("nowhere");
  const SegmentFlusher flusher(alone, "nowhere", header, rows, {}, store);
  TreeRecorder recorder({display, keeper, flusher}, tree, {});
  add({ended(base_work(), EndReason::period_limit, 5, 12), located(o), located(p), located(q),
       arrived(work_from(p, 0), 16, q, 0)});
  const queue::Task start = task_of(StartWork{work_from(q, 0)});
  const queue::Task other = task_of(StartWork{work_from(q, 1)});
  ASSERT_FALSE(recorder.wanted(start));
  ASSERT_TRUE(recorder.wanted(other));
  recorder.left_out(start);
  EXPECT_THAT(recorder.wanted_after_all(), IsEmpty());
  // P's family turns out to be O's from the other end: its arrival at Q counts no more, and O's end is at P.
  add({arrived(work_from(o, 0), 15, p, 0)});
  EXPECT_THAT(recorder.wanted_after_all(), ElementsAre(start));
  EXPECT_THAT(recorder.wanted_after_all(), IsEmpty()) << "once";
}

TEST_F(TreeRounds, ACrossingWhoseKernelFailsKeepsItsRowAndIsAFailure) {
  Ended place = located(p, 0);
  add({ended(base_work(), EndReason::period_limit, 5, 12), failed(place, "the linear solver stalled")});
  const FamilyTree::Result result = tree.resolve();
  ASSERT_EQ(result.tables.crossings.size(), 1U);
  EXPECT_EQ(result.tables.crossings[0].period, p.period);
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("the linear solver stalled")));
}

}  // namespace
}  // namespace tree_rounds_test
