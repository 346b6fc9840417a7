#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/queue/message.hpp"
#include "queue/synthetic.hpp"

namespace broken_protocol_test {
namespace {

using namespace synthetic;
using orbweaver::core::Communicator;
using queue::Tag;
using queue::Task;
using queue::TaskContext;
using queue::TaskOutcome;
using testing::AllOf;
using testing::HasSubstr;

struct Injection {
  std::string bytes;
  int tag;
};

/// The wrong bytes come in the middle of a run, and all ranks must end with the same error.
class BrokenProtocol : public testing::Test {
 protected:
  const Communicator comm;

  void inject(const Injection& injection, int to) {
    MPI_Send(injection.bytes.data(), static_cast<int>(injection.bytes.size()), MPI_BYTE, to, injection.tag, comm.get());
  }

  static std::int64_t steps(TaskContext& context) {
    std::int64_t step = 0;
    while (context.report({++step, 0, {}})) sleep_us(300);
    return step;
  }

  std::string error_of_run(queue::Executor& work, queue::Observer& observer) {
    Flush flush;
    const std::string error =
        error_of([&] { queue::run(comm, waiting_root(), tasks(comm.size() - 1), work, observer, flush); });
    EXPECT_TRUE(same_everywhere(comm, error)) << error;
    EXPECT_THAT(error, HasSubstr("the run was ended on all ranks"));
    return error;
  }

  /// A worker sends it to rank 0.
  std::string error_at_root(const Injection& injection) {
    Work work([&](const Task&, TaskContext& context) {
      if (comm.rank() == comm.size() - 1) inject(injection, 0);
      steps(context);
      return TaskOutcome{};
    });
    queue::Observer nobody;
    return error_of_run(work, nobody);
  }

  /// Rank 0 sends it to the last worker, which is `busy` or idle.
  std::string error_at_worker(const Injection& injection, bool busy) {
    class Sender final : public queue::Observer {
     public:
      Sender(BrokenProtocol& test, const Injection& what) : _test(test), _injection(what) {}
      void tick(const queue::TaskCounts&) override {
        if (++_ticks == 2) _test.inject(_injection, _test.comm.size() - 1);
      }

     private:
      BrokenProtocol& _test;
      Injection _injection;
      int _ticks = 0;
    } sender(*this, injection);
    Work work([&](const Task&, TaskContext& context) {
      if (busy || comm.rank() != comm.size() - 1) steps(context);
      if (!busy && comm.size() == 2) steps(context);
      return TaskOutcome{};
    });
    return error_of_run(work, sender);
  }

  static Injection message(const queue::Message& m) { return {queue::pack(m), static_cast<int>(queue::tag_of(m))}; }

  static Injection torn() {
    Injection injection = message(queue::Alarm{"a longer text"});
    injection.bytes.resize(injection.bytes.size() - 3);
    return injection;
  }

  static Injection newer() {
    Injection injection = message(queue::Alarm{""});
    injection.bytes[8] = 9;
    return injection;
  }
};

TEST_F(BrokenProtocol, ATornMessageAtRankZero) {
  EXPECT_THAT(error_at_root(torn()), AllOf(HasSubstr("torn"), HasSubstr(fmt::format("from rank {}", comm.size() - 1))));
}

TEST_F(BrokenProtocol, ANewerMessageAtRankZero) {
  EXPECT_THAT(error_at_root(newer()), HasSubstr("format version is 9"));
}

TEST_F(BrokenProtocol, AForeignMessageAtRankZero) {
  EXPECT_THAT(error_at_root({"what is this, and why does it come here?", 4711}),
              HasSubstr("somebody else sends on this communicator"));
  EXPECT_THAT(error_at_root({"", static_cast<int>(Tag::outcome)}), HasSubstr("got 0"));
}

TEST_F(BrokenProtocol, AMessageUnderTheWrongTag) {
  Injection injection = message(queue::FlushGo{1});
  injection.tag = static_cast<int>(Tag::progress);
  EXPECT_THAT(error_at_root(injection), HasSubstr("came as progress and is a flush_go"));
}

TEST_F(BrokenProtocol, AnotherProtocolVersion) {
  EXPECT_THAT(error_at_root(message(queue::Hello{7})),
              AllOf(HasSubstr("speaks version 7"), HasSubstr("same orbweaver")));
}

TEST_F(BrokenProtocol, MessagesOutOfTurnAtRankZero) {
  EXPECT_THAT(error_at_root(message(queue::Hello{})), HasSubstr("\"hello\" that does not fit"));
  EXPECT_THAT(error_at_root(message(queue::FlushGo{0})), HasSubstr("\"flush_go\" that does not fit"));
  EXPECT_THAT(error_at_root(message(queue::Outcome{{"another", false, "", {}, "", false}, 0})),
              HasSubstr("\"outcome\" that does not fit"));
  EXPECT_THAT(error_at_root(message(queue::ProgressReport{"another", {}})),
              HasSubstr("\"progress\" that does not fit"));
  EXPECT_THAT(error_at_root(message(queue::FlushReady{0, 0})),
              HasSubstr("flush_ready for flush 0, which rank 0 did not ask for"));
  EXPECT_THAT(error_at_root(message(queue::FlushDone{0, ""})),
              HasSubstr("flush_done for flush 0, which rank 0 did not ask for"));
}

TEST_F(BrokenProtocol, AtAWorkerThatIsBusy) {
  const std::string last = fmt::format("rank {}: ", comm.size() - 1);
  EXPECT_THAT(error_at_worker(torn(), true), AllOf(HasSubstr(last), HasSubstr("torn")));
  EXPECT_THAT(error_at_worker(newer(), true), AllOf(HasSubstr(last), HasSubstr("format version is 9")));
  EXPECT_THAT(error_at_worker(message(queue::Assign{task("second")}), true),
              AllOf(HasSubstr(last), HasSubstr("assigned task \"second\"")));
  EXPECT_THAT(error_at_worker(message(queue::FlushGo{0}), true), AllOf(HasSubstr(last), HasSubstr("\"flush_go\"")));
}

TEST_F(BrokenProtocol, AtAWorkerThatIsIdle) {
  const std::string last = fmt::format("rank {}: ", comm.size() - 1);
  EXPECT_THAT(error_at_worker(torn(), false), AllOf(HasSubstr(last), HasSubstr("torn")));
  EXPECT_THAT(error_at_worker({"a foreign message, long enough to be one", 99}, false),
              AllOf(HasSubstr(last), HasSubstr("somebody else")));
}

TEST_F(BrokenProtocol, AtAWorkerThatStandsStill) {
  // The last worker has answered and waits for the others, the first of which does not report for a while.
  if (comm.size() < 3) {
    EXPECT_THAT(error_at_worker(message(queue::FlushGo{5}), true), HasSubstr("\"flush_go\""));
    return;
  }
  Work work([&](const Task&, TaskContext& context) {
    if (comm.rank() == 1) {
      sleep_us(300'000);
      inject(message(queue::FlushGo{5}), comm.size() - 1);
      sleep_us(50'000);
    }
    steps(context);
    return TaskOutcome{};
  });
  queue::Observer nobody;
  Flush flush;
  queue::Options options = waiting_root();
  options.flush_seconds = 0.1;
  const std::string error = error_of([&] { queue::run(comm, options, tasks(comm.size() - 1), work, nobody, flush); });
  EXPECT_TRUE(same_everywhere(comm, error)) << error;
  EXPECT_THAT(error, HasSubstr("waited to begin flush 0"));
}

}  // namespace
}  // namespace broken_protocol_test
