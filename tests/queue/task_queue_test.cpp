#include <algorithm>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/task_queue.hpp"

namespace task_queue_test {
namespace {

using orbweaver::core::MisuseError;
using orbweaver::queue::Task;
using orbweaver::queue::TaskCounts;
using orbweaver::queue::TaskQueue;
using orbweaver::queue::TaskState;

Task make(const std::string& key, int priority) { return {key, priority, "kind", fmt::format("payload of {}", key)}; }

std::vector<Task> many() {
  std::vector<Task> tasks;
  for (int i = 0; i < 500; ++i) tasks.push_back(make(fmt::format("k{}", i), i * 7919 % 11 - 5));
  return tasks;
}

std::vector<std::string> drain(TaskQueue& queue) {
  std::vector<std::string> keys;
  while (queue.counts().waiting > 0) {
    keys.push_back(queue.start_next().key);
    queue.finish(keys.back());
  }
  return keys;
}

TEST(TaskQueue, OrderIsPriorityThenKeyWhateverTheArrival) {
  std::vector<Task> tasks = many();
  std::vector<std::string> expected;
  {
    std::vector<Task> sorted = tasks;
    std::sort(sorted.begin(), sorted.end(), [](const Task& a, const Task& b) {
      return a.priority != b.priority ? a.priority < b.priority : a.key < b.key;
    });
    for (const Task& task : sorted) expected.push_back(task.key);
  }
  std::mt19937 random(20240607);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(tasks.begin(), tasks.end(), random);
    TaskQueue queue;
    for (const Task& task : tasks) queue.add(task);
    EXPECT_EQ(drain(queue), expected);
  }
}

TEST(TaskQueue, KeysCompareByByteAndSmallerPriorityRunsFirst) {
  TaskQueue queue;
  for (const Task& task : {make("b", 0), make("\xc3\xa9", 0), make("a", 0), make("B", 0), make("z", -1), make("A", 1)})
    queue.add(task);
  EXPECT_THAT(drain(queue), testing::ElementsAre("z", "B", "a", "b", "\xc3\xa9", "A"));
}

TEST(TaskQueue, ALateTaskOvertakes) {
  TaskQueue queue;
  queue.add(make("b", 5));
  queue.add(make("c", 5));
  EXPECT_EQ(queue.start_next().key, "b");
  queue.add(make("z", 1));
  EXPECT_EQ(queue.start_next().key, "z");
  EXPECT_EQ(queue.start_next().key, "c");
}

TEST(TaskQueue, StatesAndCounts) {
  TaskQueue queue;
  for (const char* key : {"a", "b", "c", "d"}) queue.add(make(key, 0));
  for (int i = 0; i < 3; ++i) queue.start_next();
  EXPECT_EQ(queue.finish("a"), make("a", 0));
  EXPECT_EQ(queue.fail("b"), make("b", 0));
  EXPECT_EQ(queue.counts(), (TaskCounts{1, 1, 1, 1}));
  EXPECT_EQ(queue.state("a"), TaskState::done);
  EXPECT_EQ(queue.state("b"), TaskState::failed);
  EXPECT_EQ(queue.state("c"), TaskState::running);
  EXPECT_EQ(queue.state("d"), TaskState::waiting);
  EXPECT_EQ(queue.running("c").payload, "payload of c");
  EXPECT_THAT(queue.unfinished(), testing::ElementsAre(make("c", 0), make("d", 0)));
  queue.put_back("c", "half way");
  EXPECT_EQ(queue.counts(), (TaskCounts{2, 0, 1, 1}));
  Task interrupted = make("c", 0);
  interrupted.state = "half way";
  EXPECT_EQ(queue.start_next(), interrupted);
  queue.set_state("c", "further");
  EXPECT_EQ(queue.running("c").state, "further");
  EXPECT_EQ(queue.unfinished().front().state, "further");
}

TEST(TaskQueue, ATaskThatIsPutAsideIsUnfinishedAndNotStartedAgain) {
  TaskQueue queue;
  for (const char* key : {"a", "b"}) queue.add(make(key, 0));
  queue.start_next();
  Task aside = make("a", 0);
  aside.state = "half way";
  EXPECT_EQ(queue.put_aside("a", "half way"), aside);
  EXPECT_EQ(queue.counts(), (TaskCounts{1, 0, 0, 0, 1}));
  EXPECT_EQ(queue.state("a"), TaskState::aside);
  EXPECT_EQ(queue.start_next().key, "b");
  EXPECT_THROW(queue.start_next(), MisuseError);
  EXPECT_THROW(queue.add(make("a", 0)), MisuseError);
  EXPECT_THAT(queue.unfinished(), testing::ElementsAre(aside, make("b", 0)));
}

TEST(TaskQueue, DuplicateKeysAreRefusedInEveryState) {
  TaskQueue queue;
  for (const char* key : {"a", "b", "c", "d"}) queue.add(make(key, 0));
  for (int i = 0; i < 3; ++i) queue.start_next();
  queue.finish("a");
  queue.fail("b");
  for (const char* key : {"a", "b", "c", "d"}) EXPECT_THROW(queue.add(make(key, 3)), MisuseError) << key;
  EXPECT_EQ(queue.counts(), (TaskCounts{1, 1, 1, 1}));
  EXPECT_THROW(queue.add(make("", 0)), MisuseError);
}

TEST(TaskQueue, MisuseIsRefused) {
  TaskQueue queue;
  EXPECT_THROW(queue.start_next(), MisuseError);
  queue.add(make("a", 0));
  EXPECT_THROW(queue.finish("a"), MisuseError);
  EXPECT_THROW(queue.fail("a"), MisuseError);
  EXPECT_THROW(queue.put_back("a", ""), MisuseError);
  EXPECT_THROW(queue.put_aside("a", ""), MisuseError);
  EXPECT_THROW(queue.set_state("a", ""), MisuseError);
  EXPECT_THROW((void)queue.running("a"), MisuseError);
  EXPECT_THROW((void)queue.state("b"), MisuseError);
  EXPECT_EQ(queue.counts(), (TaskCounts{1, 0, 0, 0}));
}

}  // namespace
}  // namespace task_queue_test
