#include "queue/synthetic.hpp"

namespace two_runs_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;

// A worker that says hello to a second run before rank 0 has heard every goodbye of the first must not be forgotten.
TEST(TwoRuns, EveryWorkerWorksInEachOfManyRuns) {
  const Communicator comm;
  const int workers = computing(comm, waiting_root());
  for (int round = 0; round < 10; ++round) {
    Work work([](const queue::Task&, queue::TaskContext&) {
      sleep_us(20000);
      return queue::TaskOutcome{};
    });
    queue::Observer observer;
    Flush flush;
    const queue::RunSummary summary = queue::run(comm, waiting_root(), tasks(3 * workers), work, observer, flush);
    EXPECT_EQ(summary.done, static_cast<std::size_t>(3 * workers));
    if (!comm.is_root() || comm.size() == 1) continue;
    ASSERT_EQ(summary.loads.size(), static_cast<std::size_t>(comm.size()));
    for (int rank = 1; rank < comm.size(); ++rank)
      EXPECT_GT(summary.loads[static_cast<std::size_t>(rank)].tasks, 0) << "rank " << rank;
  }
}

}  // namespace
}  // namespace two_runs_test
