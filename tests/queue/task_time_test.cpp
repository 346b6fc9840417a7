#include <map>

#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace task_time_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;
using testing::ElementsAre;

/// Tasks "long.." report and never end by themselves unless they go on from a state; all others are short.
class Some : public queue::Executor, public queue::Observer {
 public:
  TaskOutcome execute(const Task& t, TaskContext& context) override {
    ++executed[t.key];
    TaskOutcome outcome;
    outcome.children.push_back(task(t.key + ".child"));
    if (t.key.ends_with(".child")) outcome.children.clear();
    if (!t.key.starts_with("long") || t.key.ends_with(".child") || !t.state.empty()) return outcome;
    for (std::int64_t step = 1; step < 10'000; ++step) {
      sleep_us(2000);
      if (!context.report({step, 1, {}}, [&] { return "state of " + t.key; })) return outcome;
    }
    ADD_FAILURE() << t.key << " was not told to stop";
    return outcome;
  }
  void stopped(const Task& t, const TaskOutcome& outcome) override {
    EXPECT_TRUE(outcome.stopped);
    EXPECT_EQ(t.state, "state of " + t.key);
    ++stopped_calls;
  }
  void flushing(int, const queue::TaskQueue& now) override { unfinished = now.unfinished(); }

  std::map<std::string, int> executed;
  std::vector<Task> unfinished;
  int stopped_calls = 0;
};

TEST(TaskTime, ATaskThatTakesLongerIsPutAsideWithItsStateAndTheRunGoesOn) {
  const Communicator comm;
  std::vector<Task> all = tasks(40);
  all.insert(all.begin(), {task("long1", -1), task("long2", -1)});
  queue::Options options;
  options.task_seconds = 0.5;
  Flush flush;
  Some some;
  const auto summary = queue::run(comm, options, all, some, some, flush);
  EXPECT_EQ(summary.done, 80u);
  EXPECT_EQ(summary.waiting, 2u);
  EXPECT_EQ(summary.stopped, 2u);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_EQ(sum(comm, some.executed["long1"]), 1) << "not handed out again";
  EXPECT_EQ(sum(comm, some.executed["long1.child"]), 0);
  if (comm.is_root()) {
    EXPECT_THAT(summary.put_aside, ElementsAre("long1", "long2"));
    EXPECT_EQ(some.stopped_calls, 2);
    EXPECT_THAT(some.unfinished, ElementsAre(testing::Field(&Task::state, "state of long1"),
                                             testing::Field(&Task::state, "state of long2")));
  }

  Some resumed;
  const auto second = queue::run(comm, options, some.unfinished, resumed, resumed, flush);
  EXPECT_EQ(second.done, 4u);
  EXPECT_FALSE(second.stopped_early);
  EXPECT_TRUE(second.put_aside.empty());
}

TEST(TaskTime, StandingStillForFlushesDoesNotCount) {
  const Communicator comm;
  Work work([](const Task&, TaskContext& context) {
    for (std::int64_t step = 1; step <= 80; ++step) {
      sleep_us(5000);
      EXPECT_TRUE(context.report({step, 1, {}}));
    }
    return TaskOutcome{};
  });
  Flush flush([&](int) {
    MPI_Barrier(comm.get());
    sleep_us(150'000);
  });
  queue::Observer nobody;
  queue::Options options;
  options.task_seconds = 0.8;
  options.flush_seconds = 0.02;
  options.flush_share = 1e6;
  const auto summary = queue::run(comm, options, tasks(comm.size()), work, nobody, flush);
  EXPECT_GE(summary.flushes, 7) << "together longer than a task's time";
  EXPECT_EQ(summary.done, static_cast<std::size_t>(comm.size()));
  EXPECT_TRUE(summary.put_aside.empty());
}

TEST(TaskTime, ATaskThatEndsBeforeItsNextReportHasEnded) {
  const Communicator comm;
  Work work([](const Task& t, TaskContext& context) {
    if (t.key == "silent") sleep_us(1'300'000);
    for (std::int64_t step = 1; step <= 3 && t.key != "silent"; ++step) {
      sleep_us(1000);
      EXPECT_TRUE(context.report({step, 1, {}})) << "the word to end the silent task is not for this one";
    }
    return TaskOutcome{};
  });
  Flush flush;
  queue::Observer nobody;
  queue::Options options;
  options.task_seconds = 1.0;
  std::vector<Task> all = tasks(20);
  all.push_back(task("silent", -1));
  for (int i = 0; i < 20; ++i) all.push_back(task(fmt::format("later{}", i), 1));
  const auto summary = queue::run(comm, options, all, work, nobody, flush);
  EXPECT_EQ(summary.done, 41u);
  EXPECT_FALSE(summary.stopped_early);
}

}  // namespace
}  // namespace task_time_test
