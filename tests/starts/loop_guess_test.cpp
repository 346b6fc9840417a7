#include "orbweaver/starts/loop_guess.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"

namespace orbweaver::starts::loop_guess_test {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr double period = 3.0;

std::vector<double> state_at(double time) {
  const double s = turn * time / period;
  return {0.3 * std::sin(s), -s + 0.2 * std::cos(2.0 * s), 1.0 + std::cos(s), 0.5 * std::sin(3.0 * s)};
}

double largest_difference(const loop::Loop& loop, double begin) {
  double largest = 0.0;
  for (int n = 0; n < 50; ++n) {
    const std::vector<double> is = loop::state_at(loop, period * n / 50.0);
    const std::vector<double> wanted = state_at(begin + period * n / 50.0);
    for (std::size_t i = 0; i < is.size(); ++i)
      largest = std::max(largest, std::abs(i < 2 ? std::remainder(is[i] - wanted[i], turn) : is[i] - wanted[i]));
  }
  return largest;
}

TEST(LoopGuess, IsTheLoopAtAnyTimes) {
  const auto system = systems::make_system("double_pendulum");
  double before = 0.0;
  for (const int count : {40, 80}) {
    for (const bool closes : {false, true}) {
      std::vector<double> times;
      std::vector<std::vector<double>> states;
      for (int n = 0; n < count; ++n) {
        const double share = static_cast<double>(n) / count;
        times.push_back(0.7 + period * (share + 0.05 * std::sin(turn * share)));
        states.push_back(state_at(times.back()));
        for (int i : {0, 1}) states.back()[i] = std::remainder(states.back()[i], turn);  // as programs wrap them
      }
      if (closes) {
        times.push_back(times.front() + period);
        states.push_back(states.front());
      }
      const loop::Loop loop = loop_through(system->structure(), curve_through(*system, times, states, period));
      EXPECT_EQ(loop.winding, (std::vector<double>{0.0, -1.0, 0.0, 0.0}));
      EXPECT_EQ(loop.period, period);
      const double off = largest_difference(loop, 0.7);
      EXPECT_LT(off, count == 40 ? 0.02 : before / 3.5) << "of second order at least";
      if (count == 40) before = off;
    }
  }
}

TEST(LoopGuess, SpreadsWhatATrajectoryMissesOfClosing) {
  const auto system = systems::make_system("double_pendulum");
  std::vector<std::vector<double>> states;
  for (int n = 0; n <= 240; ++n) {
    states.push_back(state_at(period * n / 240.0));
    states.back()[2] += 0.01 * n / 240.0;
  }
  const loop::Loop loop = loop_through(system->structure(), states, period);
  EXPECT_EQ(loop.winding, (std::vector<double>{0.0, -1.0, 0.0, 0.0}));
  EXPECT_LT(largest_difference(loop, 0.0), 1e-12);
  EXPECT_LT(loop.cutoff, 12) << "three harmonics are enough";
}

}  // namespace
}  // namespace orbweaver::starts::loop_guess_test
