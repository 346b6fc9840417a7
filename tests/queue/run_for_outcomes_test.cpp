#include "orbweaver/queue/run_for_outcomes.hpp"

#include "orbweaver/queue/stop.hpp"
#include "queue/synthetic.hpp"

namespace run_for_outcomes_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

std::vector<Task> on_root(const Communicator& comm, std::vector<Task> made) {
  return comm.is_root() ? std::move(made) : std::vector<Task>{};
}

TEST(RunForOutcomes, GivesThemByKeyWithThoseThatFailed) {
  const Communicator comm;
  Work work([](const Task& t, TaskContext&) {
    if (t.key == "b") throw std::runtime_error("no luck");
    TaskOutcome outcome;
    outcome.payload = "result of " + t.key;
    return outcome;
  });
  const auto outcomes = queue::run_for_outcomes(comm, on_root(comm, {task("c"), task("a"), task("b", 1)}), work);
  ASSERT_TRUE(outcomes.has_value());
  ASSERT_EQ(outcomes->size(), comm.is_root() ? 3u : 0u);
  if (!comm.is_root()) return;
  EXPECT_EQ((*outcomes)[0].payload, "result of a");
  EXPECT_TRUE((*outcomes)[1].failed);
  EXPECT_EQ((*outcomes)[1].reason, "no luck");
  EXPECT_EQ((*outcomes)[2].payload, "result of c");
}

TEST(RunForOutcomes, OfNoTasksThereAreNone) {
  const Communicator comm;
  Work work([](const Task&, TaskContext&) -> TaskOutcome { throw std::logic_error("no task was given"); });
  const auto outcomes = queue::run_for_outcomes(comm, {}, work);
  ASSERT_TRUE(outcomes.has_value());
  EXPECT_TRUE(outcomes->empty());
}

TEST(RunForOutcomes, AStopLeavesNoneOnAnyRank) {
  const Communicator comm;
  Work work([](const Task&, TaskContext& context) {
    while (context.report({1, 0, {}})) sleep_us(100);
    TaskOutcome outcome;
    outcome.stopped = true;
    return outcome;
  });
  if (comm.is_root()) queue::request_stop();
  const auto outcomes = queue::run_for_outcomes(comm, on_root(comm, tasks(5)), work);
  queue::clear_stop();
  EXPECT_FALSE(outcomes.has_value());
}

}  // namespace
}  // namespace run_for_outcomes_test
