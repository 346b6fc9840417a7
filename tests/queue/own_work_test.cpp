#include <chrono>

#include <gmock/gmock.h>

#include "orbweaver/core/interruption.hpp"
#include "queue/synthetic.hpp"

namespace own_work_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

queue::Options working_root(const Communicator& comm) {
  queue::Options options;
  options.root_works_up_to = comm.size();
  return options;
}

class Counts final : public queue::Observer {
 public:
  void finished(const Task&, const TaskOutcome&) override { ++finished_tasks; }
  void flushing(int, const queue::TaskQueue& now) override {
    for (const Task& t : now.unfinished()) states_at_flush += t.state.empty() ? 0 : 1;
  }
  int finished_tasks = 0;
  int states_at_flush = 0;
};

/// Until `done`, or fails after a time that nothing here takes.
template <class Done>
void step_until(Done done) {
  const auto began = std::chrono::steady_clock::now();
  while (!done()) {
    if (std::chrono::steady_clock::now() - began > std::chrono::seconds(20)) {
      ADD_FAILURE() << "nobody was served within this step";
      return;
    }
    orbweaver::core::interruption_point();
  }
}

TEST(OwnWork, WorkersGetTasksWithinAStepOfRankZero) {
  const Communicator comm;
  constexpr int count = 100;
  Counts counts;
  std::int64_t own = 0;
  Work work([&](const Task&, TaskContext&) {
    if (comm.is_root() && ++own == 1) step_until([&] { return counts.finished_tasks == count - 1; });
    return TaskOutcome{};
  });
  Flush flush;
  const auto summary = queue::run(comm, working_root(comm), tasks(count), work, counts, flush);
  EXPECT_EQ(summary.done, static_cast<std::size_t>(count));
  if (comm.is_root()) {
    EXPECT_EQ(own, 1);
    EXPECT_EQ(summary.loads[0].tasks, 1);
  }
}

TEST(OwnWork, AFlushHasTheStateOfItsTask) {
  const Communicator comm;
  Counts counts;
  Flush flush([&](int) { MPI_Barrier(comm.get()); });
  Work work([&](const Task&, TaskContext& context) {
    for (std::int64_t step = 1; step <= 2000 && flush.calls == 0; ++step) {
      sleep_us(1000);
      EXPECT_TRUE(context.report({step, 1, {}}, [] { return std::string("here"); }));
    }
    return TaskOutcome{};
  });
  queue::Options options = working_root(comm);
  options.flush_seconds = 0.1;
  const auto summary = queue::run(comm, options, tasks(comm.size()), work, counts, flush);
  EXPECT_GE(summary.flushes, 2);
  EXPECT_EQ(summary.done, static_cast<std::size_t>(comm.size()));
  if (comm.is_root()) {
    EXPECT_EQ(counts.states_at_flush, comm.size()) << "every rank was in the middle of a task";
  }
}

}  // namespace
}  // namespace own_work_test
