#include <fmt/format.h>
#include <gmock/gmock.h>

#include "queue/synthetic.hpp"

namespace broken_run_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;
using testing::HasSubstr;

class BrokenRun : public testing::Test {
 protected:
  /// Ends only when told to.
  Work endless{[](const Task&, TaskContext& context) {
    std::int64_t step = 0;
    while (context.report({++step, 1, {}})) sleep_us(300);
    return TaskOutcome{};
  }};
  Work quick{[](const Task&, TaskContext&) { return TaskOutcome{}; }};
  const Communicator comm;
  queue::Observer nobody;
  Flush flush;

  /// Runs, and returns the error, which must be the same on all ranks.
  std::string error_of_run(const queue::Options& options, queue::Executor& work, queue::Observer& observer,
                           queue::Flusher& flusher, int count = 20) {
    const std::string error = error_of([&] { queue::run(comm, options, tasks(count), work, observer, flusher); });
    EXPECT_TRUE(same_everywhere(comm, error)) << error;
    return error;
  }
};

TEST_F(BrokenRun, AFlushThatThrowsOnOneRankEndsAll) {
  for (int bad = 0; bad < comm.size(); ++bad) {
    Flush failing([&](int number) {
      const std::int64_t ranks = sum(comm, 1);
      EXPECT_EQ(ranks, comm.size());
      if (number == 2 && comm.rank() == bad) throw std::runtime_error("no space left");
    });
    queue::Options options;
    options.flush_rows = 20;
    options.progress_seconds = 0.002;
    const std::string error = error_of_run(options, endless, nobody, failing);
    EXPECT_THAT(error, HasSubstr(fmt::format("flush 2 failed on rank {}: no space left", bad)));
    EXPECT_EQ(failing.calls, 3);
  }
}

TEST_F(BrokenRun, TheFlushAtTheEndMayThrowToo) {
  Flush failing([&](int) {
    if (comm.rank() == comm.size() - 1) throw 7;
  });
  const std::string error = error_of_run({}, quick, nobody, failing);
  EXPECT_THAT(error, HasSubstr(fmt::format("flush 0 failed on rank {}: an exception that is no std::exception",
                                           comm.size() - 1)));
}

TEST_F(BrokenRun, AFlushThatThrowsOnAllRanksIsToldOnce) {
  Flush failing([&](int) { throw std::runtime_error(fmt::format("disk gone, says rank {}", comm.rank())); });
  const std::string error = error_of_run({}, quick, nobody, failing);
  EXPECT_THAT(error, HasSubstr("on rank 0: disk gone, says rank 0"));
  if (comm.size() > 1) {
    EXPECT_THAT(error, HasSubstr(fmt::format("failed on {} of {}", comm.size(), comm.size())));
  }
}

class ThrowingObserver final : public queue::Observer {
 public:
  explicit ThrowingObserver(std::string where) : _where(std::move(where)) {}
  bool wanted(const Task&) override {
    throw_at("wanted");
    return _where != "left_out";
  }
  void left_out(const Task&) override { throw_at("left_out"); }
  void started(const Task&, int) override { throw_at("started"); }
  void progress(const Task&, const queue::Progress&, int) override { throw_at("progress"); }
  void finished(const Task&, const TaskOutcome&) override { throw_at("finished"); }
  void flushing(int, const queue::TaskQueue&) override { throw_at("flushing"); }
  void tick(const queue::TaskCounts&) override { throw_at("tick"); }

 private:
  void throw_at(const std::string& here) const {
    if (here == _where) throw std::runtime_error(fmt::format("thrown in {}", here));
  }
  std::string _where;
};

TEST_F(BrokenRun, AnObserverThatThrowsEndsAllRanks) {
  for (const std::string where : {"wanted", "left_out", "started", "progress", "finished", "flushing", "tick"}) {
    ThrowingObserver observer(where);
    queue::Options options;
    options.progress_seconds = 0.001;
    options.flush_rows = 100;
    queue::Executor& work = where == "finished" ? static_cast<queue::Executor&>(quick) : endless;
    if (where == "progress" || where == "tick") options.flush_rows = 0;
    EXPECT_THAT(error_of_run(options, work, observer, flush), HasSubstr(fmt::format("thrown in {}", where)));
  }
}

TEST_F(BrokenRun, AKeyThatComesTwiceEndsAllRanks) {
  Work twins([](const Task&, TaskContext&) { return TaskOutcome{"", false, "", {task("twin")}, ""}; });
  EXPECT_THAT(error_of_run({}, twins, nobody, flush), HasSubstr("\"twin\" was added before"));
  const std::string error = error_of([&] { queue::run(comm, {}, {task("a"), task("a")}, quick, nobody, flush); });
  EXPECT_THAT(error, HasSubstr("\"a\" was added before"));
  EXPECT_TRUE(same_everywhere(comm, error));
}

TEST_F(BrokenRun, FailingTasksDoNotEndIt) {
  Work failing([](const Task& t, TaskContext& context) -> TaskOutcome {
    EXPECT_TRUE(context.report({1, 0, {}}));
    if (t.key == "t0") throw orbweaver::core::NumericalError("a NaN");
    if (t.key == "t1") throw "text";
    if (t.key == "t2") throw std::runtime_error("");
    return {"another key", true, "", {}, ""};
  });
  const auto summary = queue::run(comm, {}, tasks(4), failing, nobody, flush);
  EXPECT_EQ(summary.failed, 4u);
  EXPECT_EQ(summary.done, 0u);
  if (!comm.is_root()) return;
  EXPECT_THAT(summary.failures, testing::ElementsAre(queue::Failure{"t0", "a NaN"},
                                                     queue::Failure{"t1", "an exception that is no std::exception"},
                                                     queue::Failure{"t2", "an exception without a message"},
                                                     queue::Failure{"t3", "the executor gave no reason"}));
}

TEST_F(BrokenRun, AfterABrokenRunTheNextOneIsWhole) {
  Flush failing([](int) { throw std::runtime_error("once"); });
  error_of_run({}, quick, nobody, failing);
  EXPECT_EQ(queue::run(comm, {}, tasks(12), quick, nobody, flush).done, 12u);
}

}  // namespace
}  // namespace broken_run_test
