#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace wanted_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

bool of_use(const std::string& key) { return hash(key, 11) % 3 != 0; }

/// Wants what `rule` says, and notes what it is asked and told.
class Chooser final : public queue::Observer {
 public:
  explicit Chooser(std::function<bool(const Task&)> rule) : _rule(std::move(rule)) {}
  bool wanted(const Task& t) override {
    EXPECT_TRUE(asked.insert(t.key).second) << t.key << " was asked for twice";
    return _rule(t);
  }
  void left_out(const Task& t) override {
    EXPECT_EQ(t.payload, "payload of " + t.key);
    EXPECT_TRUE(left.insert(t.key).second) << t.key;
  }
  void started(const Task& t, int) override {
    EXPECT_TRUE(asked.contains(t.key)) << t.key;
    started_tasks.insert(t.key);
  }
  void finished(const Task& t, const TaskOutcome&) override {
    EXPECT_FALSE(left.contains(t.key)) << t.key;
    ++finished_tasks;
  }

  std::set<std::string> asked;
  std::set<std::string> left;
  std::set<std::string> started_tasks;
  int finished_tasks = 0;

 private:
  std::function<bool(const Task&)> _rule;
};

class Wanted : public testing::Test {
 protected:
  static Task with_payload(const std::string& key, int priority = 0) {
    return task(key, priority, "payload of " + key);
  }
  static std::vector<Task> roots(int count) {
    std::vector<Task> made;
    for (int i = 0; i < count; ++i) made.push_back(with_payload(fmt::format("t{}", i)));
    return made;
  }

  const Communicator comm;
  Flush flush;
  queue::Options options;
  std::int64_t executed = 0;  // on this rank
};

TEST_F(Wanted, UnwantedTasksAreDoneWithoutBeingExecuted) {
  Work work([&](const Task& t, TaskContext&) {
    EXPECT_TRUE(of_use(t.key)) << t.key;
    ++executed;
    TaskOutcome outcome;
    outcome.payload = "result";
    if (std::count(t.key.begin(), t.key.end(), '.') < 2)
      for (int i = 0; i < 3; ++i) outcome.children.push_back(with_payload(fmt::format("{}.{}", t.key, i), i % 2));
    return outcome;
  });
  Chooser chooser([](const Task& t) { return of_use(t.key); });
  options.keep_outcomes = true;
  const auto summary =
      queue::run(comm, options, comm.is_root() ? roots(60) : std::vector<Task>{}, work, chooser, flush);
  const std::int64_t all_executed = sum(comm, executed);
  EXPECT_EQ(summary.failed + summary.waiting, 0u);
  EXPECT_FALSE(summary.stopped_early);
  if (!comm.is_root()) {
    EXPECT_TRUE(chooser.asked.empty()) << "only rank 0 is asked";
    return;
  }
  std::set<std::string> unwanted;
  std::size_t wanted = 0;
  std::vector<std::string> open;
  for (const Task& t : roots(60)) open.push_back(t.key);
  while (!open.empty()) {
    const std::string key = open.back();
    open.pop_back();
    if (!of_use(key)) {
      unwanted.insert(key);
      continue;
    }
    ++wanted;
    if (std::count(key.begin(), key.end(), '.') < 2)
      for (int i = 0; i < 3; ++i) open.push_back(fmt::format("{}.{}", key, i));
  }
  EXPECT_GT(unwanted.size(), 50u);
  EXPECT_EQ(chooser.left, unwanted);
  EXPECT_EQ(chooser.started_tasks.size(), wanted);
  EXPECT_EQ(static_cast<std::size_t>(all_executed), wanted);
  EXPECT_EQ(static_cast<std::size_t>(chooser.finished_tasks), wanted);
  EXPECT_EQ(summary.done, wanted + unwanted.size());
  ASSERT_EQ(summary.outcomes.size(), wanted + unwanted.size());
  for (const TaskOutcome& outcome : summary.outcomes) {
    TaskOutcome empty;
    empty.key = outcome.key;
    if (unwanted.contains(outcome.key)) {
      EXPECT_TRUE(outcome == empty) << outcome.key;
    } else {
      EXPECT_EQ(outcome.payload, "result") << outcome.key;
    }
  }
}

TEST_F(Wanted, IsAskedWhenATaskIsHandedOutAndNotBefore) {
  options = waiting_root();  // a rank 0 that works may find z before any worker has said hello
  const int computing = synthetic::computing(comm, options);
  class AfterFirst final : public queue::Observer {
   public:
    bool wanted(const Task& t) override { return t.key != "z" || ended == 0; }
    void left_out(const Task& t) override { left.push_back(t.key); }
    void finished(const Task&, const TaskOutcome&) override { ++ended; }
    int ended = 0;
    std::vector<std::string> left;
  } observer;
  Work work([](const Task& t, TaskContext&) {
    EXPECT_NE(t.key, "z") << "every rank had a task, so one had ended before this one's turn";
    return TaskOutcome{};
  });
  std::vector<Task> initial = tasks(computing);
  initial.push_back(task("z", 1));
  const auto summary = queue::run(comm, options, initial, work, observer, flush);
  EXPECT_EQ(summary.done, static_cast<std::size_t>(computing) + 1);
  if (!comm.is_root()) return;
  EXPECT_THAT(observer.left, testing::ElementsAre("z"));
  EXPECT_EQ(observer.ended, computing);
}

TEST_F(Wanted, NothingWantedEndsWithOneFlush) {
  Work work([&](const Task&, TaskContext&) {
    ++executed;
    return TaskOutcome{};
  });
  Chooser chooser([](const Task&) { return false; });
  const auto summary = queue::run(comm, options, roots(25), work, chooser, flush);
  EXPECT_EQ(executed, 0);
  EXPECT_EQ(summary.done, 25u);
  EXPECT_EQ(summary.flushes, 1);
  EXPECT_EQ(flush.calls, 1);
  EXPECT_EQ(chooser.left.size(), comm.is_root() ? 25u : 0u);
}

}  // namespace
}  // namespace wanted_test
