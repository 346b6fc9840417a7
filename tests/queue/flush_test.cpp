#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace flush_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

/// Ranks that make rows, hold them, and write them in flushes.
class Writers : public queue::Executor, public queue::Flusher, public queue::Observer {
 public:
  explicit Writers(const Communicator& comm) : _comm(comm) {}

  TaskOutcome execute(const Task& t, TaskContext& context) override {
    _executing = 1;
    const auto steps = static_cast<std::int64_t>(hash(t.key, 1) % 30);
    for (std::int64_t step = 1; step <= steps; ++step) {
      sleep_us(hash(t.key, static_cast<std::uint64_t>(step)) % 1000);
      _held += step;
      EXPECT_TRUE(context.report({step, step, {}}));
    }
    _executing = 0;
    return {};
  }

  void flush(int number) override {
    EXPECT_EQ(number, _flushes++);
    EXPECT_EQ(sum(_comm, number), static_cast<std::int64_t>(number) * _comm.size())
        << "all ranks are in the same flush";
    const std::int64_t executing = sum(_comm, _executing);
    if (_comm.is_root()) {
      EXPECT_EQ(executing, _running_at_flush) << "nothing may be on its way";
    }
    _written += _held;
    _held = 0;
  }

  void flushing(int number, const queue::TaskQueue& tasks_now) override {
    EXPECT_EQ(number, _flushes);
    _running_at_flush = static_cast<std::int64_t>(tasks_now.counts().running);
    _most_running = std::max(_most_running, _running_at_flush);
  }

  /// All rows were written, and the run counted as many.
  void expect_all_written(const queue::RunSummary& summary) const {
    EXPECT_EQ(_held, 0);
    EXPECT_EQ(sum(_comm, _written), summary.rows);
    EXPECT_EQ(_flushes, summary.flushes);
  }
  [[nodiscard]] std::int64_t most_running() const { return _most_running; }

 private:
  const Communicator& _comm;
  std::int64_t _executing = 0;
  std::int64_t _held = 0;
  std::int64_t _written = 0;
  int _flushes = 0;
  std::int64_t _running_at_flush = 0;
  std::int64_t _most_running = 0;
};

std::int64_t all_rows(int count) {
  std::int64_t rows = 0;
  for (const Task& t : tasks(count)) {
    const auto steps = static_cast<std::int64_t>(hash(t.key, 1) % 30);
    rows += steps * (steps + 1) / 2;
  }
  return rows;
}

TEST(Flush, ByRowsOnAllRanksTogether) {
  const Communicator comm;
  Writers writers(comm);
  queue::Options options;
  options.flush_seconds = 0;
  options.flush_rows = 500;
  options.progress_seconds = 0.005;
  const auto summary = queue::run(comm, options, tasks(100), writers, writers, writers);
  EXPECT_EQ(summary.done, 100u);
  EXPECT_EQ(summary.rows, all_rows(100));
  EXPECT_GE(summary.flushes, 4);
  EXPECT_LE(summary.flushes, all_rows(100) / 500 + 1);
  if (comm.is_root()) {
    EXPECT_GT(writers.most_running(), 0) << "flushes must also meet running work";
  }
  writers.expect_all_written(summary);
}

TEST(Flush, ByTime) {
  const Communicator comm;
  Writers writers(comm);
  queue::Options options;
  options.flush_seconds = 0.02;
  options.flush_rows = 0;
  options.flush_share = 1e6;
  const auto summary = queue::run(comm, options, tasks(100), writers, writers, writers);
  EXPECT_EQ(summary.done, 100u);
  EXPECT_GE(summary.flushes, 3);
  writers.expect_all_written(summary);
}

/// Times flushes of 20 ms, in tasks that report every millisecond for half a second a rank.
class Timed : public queue::Executor, public queue::Flusher, public queue::Observer {
 public:
  explicit Timed(const Communicator& comm) : _comm(comm) {}
  TaskOutcome execute(const Task&, TaskContext& context) override {
    for (std::int64_t step = 1; step <= 50; ++step) {
      sleep_us(1000);
      EXPECT_TRUE(context.report({step, 1, {}}));
    }
    return {};
  }
  void flush(int) override {
    MPI_Barrier(_comm.get());
    sleep_us(20'000);
    MPI_Barrier(_comm.get());
  }
  void flushing(int, const queue::TaskQueue&) override { _began = Clock::now(); }
  void flushed(int) override {
    _last = std::chrono::duration<double>(Clock::now() - _began).count();
    _seconds += _last;
  }
  /// In flushes, but for the last, which comes when the work is over.
  [[nodiscard]] double seconds() const { return _seconds - _last; }

 private:
  using Clock = std::chrono::steady_clock;
  const Communicator& _comm;
  Clock::time_point _began;
  double _last = 0.0;
  double _seconds = 0.0;
};

queue::RunSummary run_timed(const Communicator& comm, Timed& timed, double flush_seconds, double share) {
  queue::Options options;
  options.flush_seconds = flush_seconds;
  options.flush_share = share;
  return queue::run(comm, options, tasks(20 * computing(comm)), timed, timed, timed);
}

TEST(Flush, TakesNoMoreThanItsShareOfTheRun) {
  const Communicator comm;
  Timed timed(comm);
  const auto summary = run_timed(comm, timed, 0.05, 0.2);
  EXPECT_GE(summary.flushes, 3);
  if (comm.is_root()) {
    EXPECT_LT(timed.seconds(), 0.2 * summary.seconds);
  }
}

TEST(Flush, ComesAfterTenTimesItsIntervalWhateverItsShare) {
  const Communicator comm;
  Timed timed(comm);
  const auto summary = run_timed(comm, timed, 0.01, 1e-6);
  EXPECT_GE(summary.flushes, 5);
}

TEST(Flush, TheObserverHearsOfNoneThatFailed) {
  const Communicator comm;
  struct Hears final : queue::Observer {
    void flushed(int number) override { numbers.push_back(number); }
    std::vector<int> numbers;
  } hears;
  Work work([](const Task&, TaskContext&) { return TaskOutcome{}; });
  Flush flush([&](int) {
    if (comm.rank() == comm.size() - 1) throw std::runtime_error("no space left");
  });
  EXPECT_THAT(error_of([&] { (void)queue::run(comm, {}, tasks(3), work, hears, flush); }),
              testing::HasSubstr("no space left"));
  EXPECT_TRUE(hears.numbers.empty());
}

TEST(Flush, OnlyAtTheEndWhenNoThresholdIsSet) {
  const Communicator comm;
  Writers writers(comm);
  queue::Options options;
  options.flush_seconds = 0;
  options.flush_rows = 0;
  const auto summary = queue::run(comm, options, tasks(50), writers, writers, writers);
  EXPECT_EQ(summary.flushes, 1);
  writers.expect_all_written(summary);
}

TEST(Flush, AlsoBetweenTasksThatNeverReport) {
  const Communicator comm;
  Flush flush([&](int) { MPI_Barrier(comm.get()); });
  Work work([](const Task&, TaskContext&) {
    sleep_us(1000);
    return TaskOutcome{};
  });
  queue::Observer nobody;
  queue::Options options;
  options.flush_seconds = 1e-6;
  const auto summary = queue::run(comm, options, tasks(40), work, nobody, flush);
  EXPECT_EQ(summary.done, 40u);
  EXPECT_GE(summary.flushes, 5);
  EXPECT_EQ(flush.calls, summary.flushes);
}

}  // namespace
}  // namespace flush_test
