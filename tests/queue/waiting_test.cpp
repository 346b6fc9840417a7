#include <algorithm>
#include <chrono>
#include <limits>
#include <string>

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

constexpr double most = 0.03;

/// The share of a core that a run of three seconds takes of this rank. What else the machine does only adds to it: the
/// least of up to three runs, on all ranks as many. Nobody enters a run before all are there, so that none waits for a
/// slow starter.
template <class Run>
double share_of_a_core(const Communicator& comm, Run run) {
  double least = std::numeric_limits<double>::infinity();
  int all_wait = 0;
  for (int n = 0; n < 3 && all_wait == 0; ++n) {
    MPI_Barrier(comm.get());
    const auto start = std::chrono::steady_clock::now();
    const double before = cpu_seconds();
    run();
    const double cpu = cpu_seconds() - before;
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_GE(wall, 3.0) << "every rank stays to the end";
    least = std::min(least, cpu / wall);
    all_wait = least < most ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &all_wait, 1, MPI_INT, MPI_LAND, comm.get());
  }
  return least;
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
  const double share = share_of_a_core(
      comm, [&] { queue::run(comm, waiting_root(), tasks(3 * (comm.size() - 1)), work, nobody, flush); });
  if (comm.is_root()) {
    EXPECT_LT(share, most);
    RecordProperty("cpu_percent", std::to_string(100 * share));
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
  EXPECT_LT(share_of_a_core(comm, [&] { queue::run(comm, waiting_root(), tasks(1), work, nobody, flush); }), most)
      << "rank " << comm.rank();
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
  EXPECT_LT(
      share_of_a_core(comm, [&] { queue::run(comm, options, tasks(comm.size() - 1), work, nobody, flush); }), most)
      << "rank " << comm.rank();
}

}  // namespace
}  // namespace waiting_test
