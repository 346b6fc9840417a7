#include <chrono>

#include <sys/resource.h>

#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace waiting_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Use {
  double cpu;
  double wall;
};

/// What a run costs this rank. Nobody enters it before all are there, so that none waits for a slow starter.
template <class Run>
Use use_of(const Communicator& comm, Run run) {
  MPI_Barrier(comm.get());
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  run();
  return {cpu_seconds() - cpu, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

TaskOutcome sleep_for_a_second(const Task&, TaskContext& context) {
  for (std::int64_t step = 1; step <= 100; ++step) {
    sleep_us(10'000);
    EXPECT_TRUE(context.report({step, 1, {}}));
  }
  return {};
}

TEST(Waiting, RankZeroUsesLessThanThreePercentOfACoreWhileAllOthersWork) {
  const Communicator comm;
  Work work(sleep_for_a_second);
  Flush flush;
  queue::Observer nobody;
  const Use use =
      use_of(comm, [&] { queue::run(comm, waiting_root(), tasks(3 * (comm.size() - 1)), work, nobody, flush); });
  EXPECT_GE(use.wall, 3.0);
  if (comm.is_root()) {
    EXPECT_LT(use.cpu, 0.03 * use.wall);
    RecordProperty("cpu_percent", std::to_string(100 * use.cpu / use.wall));
  }
}

TEST(Waiting, NoRankSpinsWhileOneWorks) {
  const Communicator comm;
  Work work([](const Task& t, TaskContext& context) {
    for (int i = 0; i < 3; ++i) sleep_for_a_second(t, context);
    return TaskOutcome{};
  });
  Flush flush;
  queue::Observer nobody;
  const Use use = use_of(comm, [&] { queue::run(comm, waiting_root(), tasks(1), work, nobody, flush); });
  EXPECT_GE(use.wall, 3.0) << "every rank stays to the end";
  EXPECT_LT(use.cpu, 0.03 * use.wall) << "rank " << comm.rank();
}

TEST(Waiting, NoRankSpinsBeforeAFlushThatOneKeepsWaiting) {
  const Communicator comm;
  Work work([&](const Task&, TaskContext& context) {
    sleep_us(comm.rank() == 1 ? 3'000'000 : 1000);
    EXPECT_TRUE(context.report({1, 1, {}}));
    return TaskOutcome{};
  });
  Flush flush([&](int) { MPI_Barrier(comm.get()); });
  queue::Observer nobody;
  queue::Options options = waiting_root();
  options.flush_seconds = 0.2;
  const Use use = use_of(comm, [&] { queue::run(comm, options, tasks(comm.size() - 1), work, nobody, flush); });
  EXPECT_GE(use.wall, 3.0);
  EXPECT_LT(use.cpu, 0.03 * use.wall) << "rank " << comm.rank();
}

}  // namespace
}  // namespace waiting_test
