#include "timing.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "orbweaver/core/interruption.hpp"

namespace timing_test {
namespace {

using namespace orbweaver;

TEST(Timing, LeavesTheFirstRunOut) {
  int runs = 0;
  const cost::Timing timing =
      cost::timing_of([&] { std::this_thread::sleep_for(std::chrono::milliseconds(++runs == 1 ? 60 : 4)); }, 0.02);
  EXPECT_LT(timing.seconds, 0.03);
  EXPECT_GE(timing.seconds, 0.004);
  EXPECT_EQ(timing.repetitions, runs - 1);
  EXPECT_GE(timing.repetitions, 1);
}

TEST(Timing, DoesNotRepeatWhatTakesLong) {
  int runs = 0;
  const cost::Timing timing = cost::timing_of(
      [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ++runs;
      },
      0.001);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(timing.repetitions, 1);
  EXPECT_GE(timing.seconds, 0.02);
}

TEST(Timing, EndsAfterSoManyRepetitions) {
  int runs = 0;
  const cost::Timing timing = cost::timing_of([&] { ++runs; }, 10.0);
  EXPECT_EQ(timing.repetitions, cost::most_repetitions);
  EXPECT_EQ(runs, cost::most_repetitions + 1);
}

TEST(Timing, GivesUpWhatOutlastsItsPatience) {
  const auto start = std::chrono::steady_clock::now();
  const auto endless = [] {
    while (true) core::interruption_point();
  };
  EXPECT_THROW(static_cast<void>(cost::timing_of(endless, 0.02, 0.1)), cost::GivenUp);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(100));
  EXPECT_NO_THROW(static_cast<void>(cost::timing_of([] { core::interruption_point(); }, 0.001, 10.0)));
}

}  // namespace
}  // namespace timing_test
