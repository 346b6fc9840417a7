#include <atomic>
#include <chrono>
#include <map>
#include <new>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/queue/stop.hpp"
#include "queue/synthetic.hpp"

namespace states_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;

constexpr int steps_each = 40;

/// A number that all ranks of this machine see at once, without a message.
class SharedNumber {
 public:
  explicit SharedNumber(const Communicator& comm) {
    const MPI_Aint size = comm.is_root() ? sizeof(std::atomic<int>) : 0;
    void* mine = nullptr;
    MPI_Win_allocate_shared(size, 1, MPI_INFO_NULL, comm.get(), static_cast<void*>(&mine), &_window);
    MPI_Aint root_size = 0;
    int unit = 0;
    void* at_root = nullptr;
    MPI_Win_shared_query(_window, 0, &root_size, &unit, static_cast<void*>(&at_root));
    _number = comm.is_root() ? new (at_root) std::atomic<int>(0) : static_cast<std::atomic<int>*>(at_root);
    MPI_Barrier(comm.get());
  }
  SharedNumber(const SharedNumber&) = delete;
  SharedNumber& operator=(const SharedNumber&) = delete;
  ~SharedNumber() { MPI_Win_free(&_window); }

  std::atomic<int>& operator*() { return *_number; }

 private:
  MPI_Win _window = MPI_WIN_NULL;
  std::atomic<int>* _number = nullptr;
};

/// A step a row; the state is the number of steps done. Rows count as written from the flush on, and what a flush
/// writes stays only if the queue was told that it succeeded, as in a program that is killed and begun again.
class Steps : public queue::Executor, public queue::Flusher, public queue::Observer {
 public:
  explicit Steps(const Communicator& comm) : _comm(comm) {}

  TaskOutcome execute(const Task& t, TaskContext& context) override {
    _before = _held.size();
    const int flushes = _flushes_seen;
    int step = t.state.empty() ? 0 : std::stoi(t.state);
    const bool has_state = step > 0;
    if (has_state) ++_gone_on;
    const auto report = [&](int rows) {
      return context.report({step, rows, {}}, [&] { return std::to_string(step); });
    };
    while (step < steps_each) {
      sleep_us(hash(t.key, static_cast<std::uint64_t>(step)) % 300);
      _held.emplace_back(t.key, step++);
      if (_hanging != nullptr && step == steps_each / 2) hang();
      if (!report(1)) break;
      // A task hangs with a state that it can go on from, however slowly flushes come.
      while (_hanging != nullptr && step == steps_each / 2 - 1 && !has_state && _flushes_seen == flushes) {
        sleep_us(100);
        if (!report(0)) return {};
      }
    }
    return {};
  }

  void take_back_rows(bool flushed) override {
    _held.resize(flushed ? 0 : _before);
    ++_given_up;
  }

  void flush(int) override {
    MPI_Barrier(_comm.get());
    for (const auto& row : _held) ++_written[row];
    _held.clear();
    ++_flushes_seen;
  }

  void flushing(int number, const queue::TaskQueue& now) override {
    if (number == _dies_at) throw std::runtime_error("killed here");
    _snapshot = now.unfinished();
  }
  void flushed(int number) override {
    if (_comm.is_root()) {
      EXPECT_EQ(number, _flushed++);
    }
    _unfinished = _snapshot;
  }

  void die_at(int flush) {
    _dies_at = flush;
    _flushed = 0;
  }
  /// Every task stays in the middle of one of its steps, with a row that was not reported, and says so in `hanging`.
  void hang_in_the_middle(std::atomic<int>& hanging) { _hanging = &hanging; }
  void hang_no_more() { _hanging = nullptr; }
  [[nodiscard]] std::int64_t given_up() const { return sum(_comm, _given_up); }
  void forget_rows_in_hand() { _held.clear(); }
  [[nodiscard]] const std::vector<Task>& unfinished() const { return _unfinished; }
  [[nodiscard]] std::int64_t gone_on() const { return sum(_comm, _gone_on); }

  /// Every step of every task has been written by one rank, once.
  void expect_each_once(int count) const {
    std::vector<std::int64_t> written;
    for (const Task& t : tasks(count))
      for (int step = 0; step < steps_each; ++step) {
        const auto found = _written.find({t.key, step});
        written.push_back(found == _written.end() ? 0 : found->second);
      }
    MPI_Allreduce(MPI_IN_PLACE, written.data(), static_cast<int>(written.size()), MPI_INT64_T, MPI_SUM, _comm.get());
    EXPECT_THAT(written, testing::Each(1));
  }

 private:
  void hang() {
    ++*_hanging;
    const auto began = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - began < std::chrono::seconds(20)) orbweaver::core::interruption_point();
    ADD_FAILURE() << "nobody has asked for the end of this step";
  }

  const Communicator& _comm;
  std::size_t _before = 0;
  std::atomic<int>* _hanging = nullptr;
  int _flushes_seen = 0;
  std::int64_t _given_up = 0;
  std::vector<std::pair<std::string, int>> _held;
  std::map<std::pair<std::string, int>, int> _written;
  std::vector<Task> _snapshot;
  std::vector<Task> _unfinished;
  std::int64_t _gone_on = 0;
  int _dies_at = -1;
  int _flushed = 0;
};

queue::Options often() {
  queue::Options options;
  options.flush_seconds = 0;
  options.flush_rows = 60;
  options.progress_seconds = 0.001;
  return options;
}

TEST(States, AStopWithinAStepGoesOnFromTheLastFlush) {
  const Communicator comm;
  Steps steps(comm);
  constexpr int count = 30;
  std::vector<Task> remaining = tasks(count);
  queue::Options options = often();
  options.flush_rows = 5;  // what a task has done before its middle is enough for a flush
  for (const int victim : {0, comm.size() - 1}) {
    steps.die_at(-1);
    SharedNumber hanging(comm);
    steps.hang_in_the_middle(*hanging);
    std::thread stopper([&] {
      while (*hanging == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (comm.rank() == victim) queue::request_stop();
    });
    const auto summary = queue::run(comm, options, remaining, steps, steps, steps);
    stopper.join();
    queue::clear_stop();
    EXPECT_TRUE(summary.stopped_early);
    remaining = steps.unfinished();
  }
  EXPECT_GE(steps.given_up(), 2);
  steps.die_at(-1);
  steps.hang_no_more();
  EXPECT_FALSE(queue::run(comm, options, remaining, steps, steps, steps).stopped_early);
  EXPECT_GT(steps.gone_on(), 0) << "some task must have gone on from a state";
  steps.expect_each_once(count);
}

TEST(States, ARunThatEndsBetweenFlushesGoesOnFromTheLastOne) {
  const Communicator comm;
  Steps steps(comm);
  constexpr int count = 60;
  std::vector<Task> remaining = tasks(count);
  const std::vector<int> deaths{4, 2, 1};
  // On a busy machine flushes may all come between two tasks: some more runs then end as well.
  for (std::size_t n = 0; n < deaths.size() || (n < 10 && steps.gone_on() == 0); ++n) {
    steps.die_at(n < deaths.size() ? deaths[n] : 1);
    EXPECT_THAT(error_of([&] { (void)queue::run(comm, often(), remaining, steps, steps, steps); }),
                testing::HasSubstr("killed here"));
    steps.forget_rows_in_hand();
    remaining = steps.unfinished();
  }
  steps.die_at(-1);
  const auto summary = queue::run(comm, often(), remaining, steps, steps, steps);
  EXPECT_FALSE(summary.stopped_early);
  EXPECT_GT(steps.gone_on(), 0) << "some task must have been in the middle of its steps";
  if (comm.is_root()) {
    EXPECT_TRUE(steps.unfinished().empty());
  }
  steps.expect_each_once(count);
}

/// Asks for a stop when a task has come to its tenth step, on one rank.
class StopsOnce : public Steps {
 public:
  StopsOnce(const Communicator& comm, int rank) : Steps(comm), _asks(comm.rank() == rank) {}
  TaskOutcome execute(const Task& t, TaskContext& context) override {
    if (_asks && _calls++ == 2) queue::request_stop();
    return Steps::execute(t, context);
  }

 private:
  bool _asks;
  int _calls = 0;
};

TEST(States, AStoppedTaskWaitsWithItsState) {
  const Communicator comm;
  constexpr int count = 60;
  StopsOnce steps(comm, comm.size() - 1);  // a request on any rank counts
  const auto first = queue::run(comm, often(), tasks(count), steps, steps, steps);
  queue::clear_stop();
  EXPECT_TRUE(first.stopped_early);
  const std::vector<Task> remaining = steps.unfinished();
  steps.die_at(-1);
  const auto second = queue::run(comm, often(), remaining, steps, steps, steps);
  EXPECT_FALSE(second.stopped_early);
  EXPECT_GT(steps.gone_on(), 0);
  steps.expect_each_once(count);
}

}  // namespace
}  // namespace states_test
