#include "failure.hpp"

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"

namespace failure_test {
namespace {

namespace core = orbweaver::core;
using namespace orbweaver::drivers;

template <class Exception>
Failure described(const Exception& exception) {
  return describe_failure(std::make_exception_ptr(exception));
}

TEST(Failure, EveryKindHasItsStatus) {
  EXPECT_EQ(described(core::InputError("bad")).status, 2);
  EXPECT_EQ(described(core::InputError("bad")).message, "bad");
  EXPECT_EQ(described(core::EnvironmentError("disk")).status, 3);
  EXPECT_EQ(described(core::NumericalError("nan")).status, 1);
  EXPECT_EQ(described(std::runtime_error("other")).status, 3);
  EXPECT_EQ(described(42).status, 3);
  const Failure misuse = described(core::MisuseError("contract"));
  EXPECT_EQ(misuse.status, 3);
  EXPECT_EQ(misuse.message.find("internal error"), 0U) << misuse.message;
}

std::string printed(const std::exception_ptr& error, int expected_status) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(report_failure(error), expected_status);
  return testing::internal::GetCapturedStderr();
}

TEST(Agree, PassesWhenNobodyFails) {
  const core::Communicator comm;
  EXPECT_NO_THROW(agree(comm, [] {}));
}

TEST(Agree, WhenAllFailOneRankPrintsAndAllHaveTheStatus) {
  const core::Communicator comm;
  std::exception_ptr error;
  try {
    agree(comm, [] { throw core::InputError("bad scene"); });
  } catch (...) {
    error = std::current_exception();
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(printed(error, 2), comm.is_root() ? "orbweaver: bad scene\n" : "");
}

TEST(Agree, WhenTheLastRankFailsTheOthersStopToo) {
  const core::Communicator comm;
  const bool fails = comm.rank() == comm.size() - 1;
  std::exception_ptr error;
  try {
    run_on_ranks(comm, [&] {
      agree(comm, [&] {
        if (fails) throw core::EnvironmentError("disk full");
      });
      return 0;
    });
  } catch (...) {
    error = std::current_exception();
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(printed(error, 3), fails ? "orbweaver: disk full\n" : "");
}

TEST(RunOnRanks, ReturnsWhatTheBodyReturns) {
  const core::Communicator comm;
  EXPECT_EQ(run_on_ranks(comm, [] { return 4; }), 4);
}

TEST(RunOnRanks, AloneAnExceptionPassesThrough) {
  const core::Communicator alone(MPI_COMM_SELF);
  const auto body = []() -> int { throw core::NumericalError("a NaN"); };
  EXPECT_THROW(run_on_ranks(alone, body), core::NumericalError);
}

}  // namespace
}  // namespace failure_test
