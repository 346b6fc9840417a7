#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace run_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

int depth_of(const std::string& key) { return static_cast<int>(std::count(key.begin(), key.end(), '.')); }

/// The outcome of a task of the forest, a pure function of it, without the time it takes.
TaskOutcome forest_outcome(const Task& t) {
  TaskOutcome outcome;
  outcome.key = t.key;
  const std::uint64_t h = hash(t.key, 1);
  if (h % 19 == 0 || h % 23 == 0) {
    outcome.failed = true;
    outcome.reason = h % 19 == 0 ? fmt::format("no luck with {}", t.key) : "an exception that is no std::exception";
    return outcome;
  }
  outcome.failed = h % 29 == 0;
  if (outcome.failed) outcome.reason = "came half the way";
  const auto children = depth_of(t.key) < 3 ? hash(t.key, 2) % 4 : 0;
  for (std::uint64_t i = 0; i < children; ++i) {
    const std::string key = fmt::format("{}.{}", t.key, i);
    outcome.children.push_back(task(key, static_cast<int>(hash(key, 3) % 5) - 2, fmt::format("payload of {}", key)));
  }
  outcome.payload = fmt::format("result of {}{}", t.payload, std::string(hash(t.key, 4) % 2000, 'x'));
  return outcome;
}

TaskOutcome do_forest(const Task& t, TaskContext& context) {
  const std::uint64_t steps = hash(t.key, 5) % 4;
  for (std::uint64_t i = 0; i < steps; ++i) {
    sleep_us(hash(t.key, 6 + i) % 300);
    EXPECT_TRUE(context.report({static_cast<std::int64_t>(i) + 1, 0, {}}));
  }
  const TaskOutcome outcome = forest_outcome(t);
  if (hash(t.key, 1) % 19 == 0) throw std::runtime_error(outcome.reason);
  if (hash(t.key, 1) % 23 == 0) throw 42;
  return outcome;
}

std::vector<Task> forest_roots() {
  std::vector<Task> roots;
  for (int i = 0; i < 400; ++i) {
    const std::string key = fmt::format("r{}", i);
    roots.push_back(task(key, static_cast<int>(hash(key, 3) % 5) - 2, fmt::format("payload of {}", key)));
  }
  return roots;
}

std::vector<TaskOutcome> forest_reference() {
  std::vector<TaskOutcome> outcomes;
  std::vector<Task> open = forest_roots();
  while (!open.empty()) {
    const Task t = open.back();
    open.pop_back();
    outcomes.push_back(forest_outcome(t));
    for (const Task& child : outcomes.back().children) open.push_back(child);
  }
  std::sort(outcomes.begin(), outcomes.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  return outcomes;
}

class Watch final : public queue::Observer {
 public:
  void started(const Task& t, int rank) override {
    EXPECT_TRUE(running.emplace(t.key, rank).second) << t.key;
    order.push_back(t.key);
  }
  void progress(const Task& t, const queue::Progress& p, int rank) override {
    EXPECT_TRUE(running.contains(t.key) && running[t.key] == rank) << t.key;
    EXPECT_GT(p.step, last_step[t.key]) << t.key;
    last_step[t.key] = p.step;
    ++reports[t.key];
    rows += p.rows;
    EXPECT_THAT(p.values, testing::ElementsAre(static_cast<double>(p.step) / 2));
  }
  void finished(const Task& t, const TaskOutcome& outcome) override {
    EXPECT_FALSE(outcome.failed);
    end(t, outcome);
  }
  void failed(const Task& t, const TaskOutcome& outcome) override {
    EXPECT_TRUE(outcome.failed);
    end(t, outcome);
  }
  void tick(const queue::TaskCounts&) override { ++ticks; }

  std::map<std::string, int> running;
  std::map<std::string, std::int64_t> last_step;
  std::map<std::string, int> reports;
  std::vector<std::string> order;
  std::int64_t rows = 0;
  int ended = 0;
  int ticks = 0;

 private:
  void end(const Task& t, const TaskOutcome& outcome) {
    EXPECT_EQ(t.key, outcome.key);
    EXPECT_EQ(running.erase(t.key), 1u);
    ++ended;
  }
};

TEST(Run, WhatATaskThrowsIsKeptAsItCanBeShown) {
  const Communicator comm;
  Work work([](const Task&, TaskContext&) -> TaskOutcome { throw std::runtime_error("Kr\xF6mmung"); });
  Flush flush;
  queue::Observer nobody;
  const auto summary = queue::run(comm, {}, tasks(1), work, nobody, flush);
  ASSERT_EQ(summary.failed, 1u);
  if (comm.is_root()) {
    EXPECT_EQ(summary.failures[0].reason, "Kr\\xf6mmung");
  }
}

TEST(Run, OutcomesAreThoseOfTheReferenceWhateverTheNumberOfRanks) {
  const Communicator comm;
  Work work(do_forest);
  Flush flush;
  Watch watch;
  queue::Options options;
  options.keep_outcomes = true;
  options.progress_seconds = 1000;
  const auto summary =
      queue::run(comm, options, comm.is_root() ? forest_roots() : std::vector<Task>{}, work, watch, flush);
  const auto reference = forest_reference();
  const auto failed = static_cast<std::size_t>(
      std::count_if(reference.begin(), reference.end(), [](const auto& o) { return o.failed; }));
  EXPECT_GT(reference.size(), 2000u);
  EXPECT_GT(failed, 100u);
  EXPECT_EQ(summary.done, reference.size() - failed);
  EXPECT_EQ(summary.failed, failed);
  EXPECT_EQ(summary.waiting, 0u);
  EXPECT_FALSE(summary.stopped_early);
  EXPECT_GE(summary.flushes, 1);
  EXPECT_EQ(flush.calls, summary.flushes);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.outcomes.size(), reference.size());
  EXPECT_TRUE(summary.outcomes == reference);
  std::vector<queue::Failure> failures;
  for (const TaskOutcome& o : reference)
    if (o.failed) failures.push_back({o.key, o.reason});
  EXPECT_TRUE(summary.failures == failures);
  EXPECT_EQ(watch.ended, static_cast<int>(reference.size()));
  EXPECT_TRUE(watch.running.empty());
  std::int64_t tasks_done = 0;
  for (const queue::RankLoad& load : summary.loads) tasks_done += load.tasks;
  EXPECT_EQ(tasks_done, static_cast<std::int64_t>(reference.size()));
  EXPECT_EQ(summary.loads.size(), static_cast<std::size_t>(comm.size()));
  EXPECT_EQ(summary.loads[0].tasks == 0, comm.size() > options.root_works_up_to) << "rank 0 works among few";
}

TEST(Run, OneThatWorksTakesTheTasksInTheOrderOfTheQueue) {
  const Communicator comm;
  Work work([](const Task& t, TaskContext&) { return forest_outcome(t); });
  Flush flush;
  Watch watch;
  queue::run(comm, {}, comm.is_root() ? forest_roots() : std::vector<Task>{}, work, watch, flush);
  if (!comm.is_root() || computing(comm) > 1) return;
  std::map<std::pair<int, std::string>, Task> reference;
  const auto add = [&](const Task& t) { reference.emplace(std::pair(t.priority, t.key), t); };
  for (const Task& t : forest_roots()) add(t);
  std::vector<std::string> order;
  while (!reference.empty()) {
    const Task t = reference.extract(reference.begin()).mapped();
    order.push_back(t.key);
    for (const Task& child : forest_outcome(t).children) add(child);
  }
  EXPECT_EQ(watch.order, order);
}

TEST(Run, WithoutTasksItFlushesOnceAndEnds) {
  const Communicator comm;
  Work work([](const Task&, TaskContext&) { return TaskOutcome{}; });
  Flush flush;
  queue::Observer nobody;
  const auto summary = queue::run(comm, {}, {}, work, nobody, flush);
  EXPECT_EQ(summary.done + summary.failed + summary.waiting, 0u);
  EXPECT_EQ(summary.flushes, 1);
  EXPECT_EQ(flush.calls, 1);
}

TEST(Run, RunsFollowEachOtherOnOneCommunicator) {
  const Communicator comm;
  for (int i = 0; i < 20; ++i) {
    Work work([](const Task& t, TaskContext&) { return TaskOutcome{"", false, "", {}, t.key}; });
    Flush flush;
    queue::Observer nobody;
    const auto summary = queue::run(comm, {}, tasks(i), work, nobody, flush);
    EXPECT_EQ(summary.done, static_cast<std::size_t>(i));
  }
}

TEST(Run, PayloadsOfEverySizeArriveWhole) {
  const Communicator comm;
  const auto bytes_of = [](const std::string& key) {
    const std::uint64_t size = hash(key, 1) % 3 == 0 ? hash(key, 2) % 6'000'000 : hash(key, 2) % 9000;
    std::string bytes(key == "t0" ? 0 : size, '\0');
    const std::uint64_t first = hash(key, 3);
    for (std::size_t i = 0; i < bytes.size(); i += 7) bytes[i] = static_cast<char>(first + i);
    return bytes;
  };
  Work work([&](const Task& t, TaskContext&) {
    TaskOutcome outcome;
    outcome.failed = t.payload != bytes_of(t.key);
    outcome.payload.assign(t.payload.rbegin(), t.payload.rend());
    return outcome;
  });
  Flush flush;
  queue::Observer nobody;
  queue::Options options;
  options.keep_outcomes = true;
  std::vector<Task> initial;
  for (int i = 0; i < 60 && comm.is_root(); ++i)
    initial.push_back(task(fmt::format("t{}", i), 0, bytes_of(fmt::format("t{}", i))));
  const auto summary = queue::run(comm, options, initial, work, nobody, flush);
  EXPECT_EQ(summary.done, 60u);
  EXPECT_EQ(summary.failed, 0u);
  for (const TaskOutcome& outcome : summary.outcomes) {
    const std::string bytes = bytes_of(outcome.key);
    EXPECT_TRUE(std::equal(bytes.rbegin(), bytes.rend(), outcome.payload.begin(), outcome.payload.end()))
        << outcome.key;
  }
}

TEST(Run, ProgressArrivesGrowsAndCountsAllRows) {
  const Communicator comm;
  Work work([](const Task&, TaskContext& context) {
    for (std::int64_t step = 1; step <= 60; ++step) {
      sleep_us(2000);
      EXPECT_TRUE(context.report({step, 3, {static_cast<double>(step) / 2}}));
    }
    return TaskOutcome{};
  });
  Flush flush;
  Watch watch;
  queue::Options options;
  options.progress_seconds = 0.01;
  const int count = 2 * comm.size();
  const auto summary = queue::run(comm, options, tasks(count), work, watch, flush);
  EXPECT_EQ(summary.done, static_cast<std::size_t>(count));
  EXPECT_EQ(summary.rows, 180 * count);
  if (!comm.is_root()) return;
  for (int i = 0; i < count; ++i) EXPECT_GE(watch.reports[fmt::format("t{}", i)], 3);
  EXPECT_LE(watch.rows, 180 * count);
  EXPECT_GT(watch.rows, 0);
  EXPECT_GE(watch.ticks, 1);
}

TEST(Run, ProgressIsHeldBackBetweenIntervals) {
  const Communicator comm;
  Work work([](const Task&, TaskContext& context) {
    for (std::int64_t step = 1; step <= 20'000; ++step)
      EXPECT_TRUE(context.report({step, 1, {static_cast<double>(step) / 2}}));
    return TaskOutcome{};
  });
  Flush flush;
  Watch watch;
  queue::Options options;
  options.progress_seconds = 1000;
  const auto summary = queue::run(comm, options, tasks(1), work, watch, flush);
  EXPECT_EQ(summary.rows, 20'000);
  EXPECT_TRUE(watch.reports.empty());
}

TEST(Run, OptionsOutOfRangeAreRefusedOnEveryRank) {
  const Communicator comm;
  Work work([](const Task&, TaskContext&) { return TaskOutcome{}; });
  Flush flush;
  queue::Observer nobody;
  const auto refused = [&](const auto& spoil) {
    queue::Options options;
    spoil(options);
    EXPECT_THROW(queue::run(comm, options, tasks(1), work, nobody, flush), orbweaver::core::MisuseError);
  };
  refused([](queue::Options& o) { o.flush_seconds = -1; });
  refused([](queue::Options& o) { o.flush_seconds = std::nan(""); });
  refused([](queue::Options& o) { o.flush_rows = -1; });
  refused([](queue::Options& o) { o.flush_share = 0; });
  refused([](queue::Options& o) { o.task_seconds = -1; });
  refused([](queue::Options& o) { o.progress_seconds = -1; });
  refused([](queue::Options& o) { o.tick_seconds = -1; });
  refused([](queue::Options& o) { o.shortest_sleep = std::chrono::microseconds(0); });
  refused([](queue::Options& o) { o.longest_sleep = std::chrono::microseconds(1); });
  EXPECT_EQ(flush.calls, 0);
}

}  // namespace
}  // namespace run_test
