#include <csignal>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/queue/stop.hpp"
#include "queue/synthetic.hpp"

namespace stop_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

class Stop : public testing::Test {
 protected:
  Stop() { queue::clear_stop(); }
  ~Stop() override { queue::clear_stop(); }

  const Communicator comm;
  Flush flush;
  queue::Options options;
  Work endless{[](const Task& t, TaskContext& context) {
    std::int64_t step = 0;
    while (context.report({++step, 1, {}})) sleep_us(500);
    EXPECT_FALSE(context.report({++step, 0, {}})) << "once false, always false";
    return TaskOutcome{"", false, "", {task(fmt::format("{}.child", t.key))}, fmt::format("frontier of {}", t.key)};
  }};
};

class Stopper final : public queue::Observer {
 public:
  explicit Stopper(std::function<void()> stop) : _stop(std::move(stop)) {}
  void tick(const queue::TaskCounts& counts) override {
    if (++_ticks == 3) _stop();
    most_running = std::max(most_running, counts.running);
  }
  void stopped(const Task& t, const TaskOutcome& outcome) override {
    EXPECT_TRUE(outcome.stopped);
    EXPECT_EQ(outcome.payload, fmt::format("frontier of {}", t.key));
    ++stopped_tasks;
  }
  void finished(const Task& t, const TaskOutcome&) override { ADD_FAILURE() << t.key << " has not finished"; }
  void failed(const Task& t, const TaskOutcome&) override { ADD_FAILURE() << t.key << " has not failed"; }

  std::size_t stopped_tasks = 0;
  std::size_t most_running = 0;

 private:
  std::function<void()> _stop;
  int _ticks = 0;
};

TEST_F(Stop, EndsRunningWorkAndLeavesItWaiting) {
  Stopper stopper(&queue::request_stop);
  options.keep_outcomes = true;
  const auto summary = queue::run(comm, options, tasks(30), endless, stopper, flush);
  const auto running = static_cast<std::size_t>(computing(comm));
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_EQ(summary.done, 0u);
  EXPECT_EQ(summary.failed, 0u);
  EXPECT_EQ(summary.waiting, 30u) << "the stopped ones too, and no child of theirs";
  EXPECT_EQ(summary.stopped, running);
  EXPECT_EQ(summary.flushes, flush.calls);
  EXPECT_GE(summary.flushes, 1);
  if (!comm.is_root()) return;
  EXPECT_EQ(stopper.stopped_tasks, running);
  EXPECT_EQ(summary.outcomes.size(), running);
  for (const TaskOutcome& outcome : summary.outcomes) EXPECT_TRUE(outcome.stopped);
}

TEST_F(Stop, MayComeFromASignalHandler) {
  std::signal(SIGUSR1, [](int) { queue::request_stop(); });
  Stopper stopper([] { std::raise(SIGUSR1); });
  const auto summary = queue::run(comm, options, tasks(3), endless, stopper, flush);
  std::signal(SIGUSR1, SIG_DFL);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_EQ(summary.waiting, 3u);
}

TEST_F(Stop, MayComeInTheMiddleOfFlushes) {
  options.flush_seconds = 1e-6;
  Stopper stopper(&queue::request_stop);
  const auto summary = queue::run(comm, options, tasks(30), endless, stopper, flush);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_EQ(summary.waiting, 30u);
  EXPECT_EQ(summary.flushes, flush.calls);
}

TEST_F(Stop, BeforeTheRunIsNotLost) {
  if (comm.is_root()) queue::request_stop();
  Stopper stopper([] {});
  const auto summary = queue::run(comm, options, tasks(5), endless, stopper, flush);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_EQ(summary.waiting, 5u);
  EXPECT_EQ(flush.calls, 1);
}

TEST_F(Stop, AfterTheLastTaskIsNoEarlyStop) {
  Work work([](const Task&, TaskContext&) { return TaskOutcome{}; });
  class : public queue::Observer {
   public:
    void finished(const Task&, const TaskOutcome&) override {
      if (++ended == 7) queue::request_stop();
    }
    int ended = 0;
  } observer;
  const auto summary = queue::run(comm, options, tasks(7), work, observer, flush);
  EXPECT_EQ(summary.done, 7u);
  EXPECT_FALSE(summary.stopped_early);
}

TEST_F(Stop, AWorkerPassesItsOwnRequestOn) {
  if (comm.rank() == comm.size() - 1) queue::request_stop();
  Work work([](const Task&, TaskContext& context) {
    while (context.report({1, 0, {}})) sleep_us(100);
    return TaskOutcome{};
  });
  queue::Observer nobody;
  const auto summary = queue::run(comm, options, tasks(9), work, nobody, flush);
  EXPECT_LT(summary.done, 9u);
  EXPECT_TRUE(summary.stopped_early);
}

}  // namespace
}  // namespace stop_test
