#include "orbweaver/loop/curve/loop.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::loop::loop_test {
namespace {

using test::direct_sum;
using test::random_loop;
using test::two_pi;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// sqrt of the mean over a period by the trapezium rule, exact for trigonometric polynomials of degree < points.
double rms_over_period(const std::function<double(double)>& square_at, int points = 200) {
  double sum = 0.0;
  for (int j = 0; j < points; ++j) sum += square_at(two_pi * j / points);
  return std::sqrt(sum / points);
}

Loop winding_loop() {
  Loop loop = random_loop(4, 6, 11);
  loop.winding = {1.0, -2.0, 0.0, 0.0};
  return loop;
}

TEST(Loop, KeepsModesInTheOrderOfTheArchive) {
  Loop loop = constant_loop(std::vector<double>{1.0, 2.0}, 3.0, 2);
  loop.cosine(1, 0) = 3.0;
  loop.cosine(1, 1) = 4.0;
  loop.sine(1, 0) = 5.0;
  loop.sine(1, 1) = 6.0;
  loop.cosine(2, 0) = 7.0;
  loop.sine(2, 1) = 8.0;
  EXPECT_EQ(loop.modes, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 0, 0, 8}));
  const Loop& constant = loop;
  EXPECT_EQ(constant.cosine(0, 1), 2.0);
  EXPECT_EQ(constant.sine(2, 1), 8.0);
  EXPECT_EQ(loop.winding, (std::vector<double>{0, 0}));
}

TEST(Loop, ConstantLoopStaysAtItsPoint) {
  const std::vector<double> point{0.3, -1.7, 2.5};
  const Loop loop = constant_loop(point, 2.0, 5);
  for (const double t : {0.0, 0.7, -13.0, 1e9}) EXPECT_EQ(state_at(loop, t), point);
  EXPECT_EQ(rms_speed(loop), 0.0);
  EXPECT_EQ(rms_amplitude(loop), 0.0);
  EXPECT_EQ(tail(loop), 0.0);
}

TEST(Loop, EvaluatesTheSeries) {
  for (const int cutoff : {1, 2, 7, 40}) {
    Loop loop = random_loop(3, cutoff, 5, 3.7, 0.95);
    loop.winding = {0.0, 2.0, -1.0};
    for (const double turns : {0.0, 0.123, 0.5, 0.987, 1.25, -0.4}) {
      const std::vector<double> expected = direct_sum(loop, two_pi * turns).state;
      EXPECT_LT(test::distance(state_at(loop, turns * loop.period), expected), 2e-13)
          << "K = " << cutoff << ", turns " << turns;
    }
  }
}

TEST(Loop, KeepsItsDigitsAtLargeTimes) {
  const Loop still = random_loop(2, 30, 3, 2.0, 0.95);
  // Exact in binary: the phase is the same, so every bit has to be.
  EXPECT_EQ(state_at(still, 2.0 * (1048576.0 + 0.25)), state_at(still, 0.5));
  EXPECT_EQ(state_at(still, -2.0 * 1048576.0 + 0.5), state_at(still, 0.5));
  Loop winding = still;
  winding.winding = {3.0, 0.0};
  const std::vector<double> later = state_at(winding, 2.0 * (1024.0 + 0.25));
  const std::vector<double> now = state_at(winding, 0.5);
  EXPECT_NEAR(later[0] - now[0], 3.0 * 1024.0 * two_pi, 1e-11);
  EXPECT_EQ(later[1], now[1]);
}

TEST(Loop, MoreHarmonicsChangeNothing) {
  const Loop loop = winding_loop();
  const Loop padded = with_cutoff(loop, 13);
  EXPECT_EQ(padded.cutoff, 13);
  EXPECT_NO_THROW(validate(padded));
  EXPECT_EQ(mean_distance(loop, padded), 0.0);
  for (const double t : {0.0, 1.1, 3.9}) EXPECT_EQ(state_at(padded, t), state_at(loop, t));
  EXPECT_EQ(with_cutoff(padded, loop.cutoff).modes, loop.modes);
}

TEST(Loop, FewerHarmonicsDropTheLastOnes) {
  const Loop loop = winding_loop();
  const Loop shorter = with_cutoff(loop, 4);
  Loop expected = loop;
  for (int k = 5; k <= 6; ++k)
    for (int i = 0; i < 4; ++i) expected.cosine(k, i) = expected.sine(k, i) = 0.0;
  for (const double t : {0.0, 1.1, 3.9}) EXPECT_EQ(state_at(shorter, t), state_at(expected, t));
  EXPECT_GT(mean_distance(loop, shorter), 1e-3);
  EXPECT_EQ(shorter.winding, loop.winding);
  EXPECT_EQ(shorter.period, loop.period);
}

TEST(Loop, WeightedSumsAreThoseOfStatesAndScalars) {
  Loop a = winding_loop();
  a.parameters = {1.0, 5.0};
  Loop b = with_cutoff(a, 13);
  for (double& c : b.modes) c *= 3.0;
  b.period = 2.0 * a.period;
  b.parameters = {2.0, 1.0};
  const Loop sum = weighted_sum({&a, &b}, {0.25, 0.75});
  EXPECT_EQ(sum.cutoff, 13);
  EXPECT_DOUBLE_EQ(sum.period, 1.75 * a.period);
  EXPECT_EQ(sum.parameters, (std::vector<double>{1.75, 2.0}));
  EXPECT_EQ(sum.winding, a.winding);
  for (std::size_t c = 0; c < a.modes.size(); ++c) EXPECT_DOUBLE_EQ(sum.modes[c], 2.5 * a.modes[c]);
  EXPECT_THROW(static_cast<void>(weighted_sum({&a}, {0.5, 0.5})), core::MisuseError);
}

TEST(Loop, ShiftedLoopIsTheSameOrbitStartedLater) {
  const Loop loop = winding_loop();
  for (const double fraction : {0.25, 0.5, 1.0 / 3.0, -0.2, 1.7, 0.0}) {
    const Loop shifted = time_shifted(loop, fraction);
    for (const double t : {0.0, 0.4, 2.9}) {
      const std::vector<double> expected = direct_sum(loop, two_pi * (t / loop.period + fraction)).state;
      EXPECT_LT(test::distance(state_at(shifted, t), expected), 1e-13) << "fraction " << fraction << ", t = " << t;
    }
  }
  EXPECT_LT(mean_distance(time_shifted(time_shifted(loop, 0.3), -0.3), loop), 1e-14);
}

TEST(Loop, MeasuresAgreeWithQuadrature) {
  const Loop loop = winding_loop();
  Loop other = random_loop(4, 9, 12);
  other.winding = loop.winding;
  const double rate = two_pi / loop.period;
  const auto gap = [&](double s) {
    return std::pow(test::distance(direct_sum(loop, s).state, direct_sum(other, s).state), 2);
  };
  const auto speed = [&](double s) { return rate * rate * test::squared(direct_sum(loop, s).slope); };
  Loop still = loop;
  still.winding.assign(4, 0.0);
  const std::vector<double> mean(loop.modes.begin(), loop.modes.begin() + 4);
  const auto amplitude = [&](double s) { return std::pow(test::distance(direct_sum(still, s).state, mean), 2); };
  EXPECT_NEAR(mean_distance(loop, other), rms_over_period(gap), 1e-13);
  EXPECT_NEAR(mean_distance(other, loop), rms_over_period(gap), 1e-13);
  EXPECT_NEAR(rms_speed(loop), rms_over_period(speed), 1e-13);
  EXPECT_NEAR(rms_amplitude(loop), rms_over_period(amplitude), 1e-13);
}

TEST(Loop, TailLooksAtTheLastThirtySecond) {
  Loop loop = constant_loop(std::vector<double>{9.0, 9.0}, 1.0, 160);
  loop.cosine(155, 0) = 5.0;
  EXPECT_EQ(tail(loop), 0.0);
  loop.cosine(156, 0) = 3.0;
  loop.sine(156, 1) = 4.0;
  loop.sine(160, 1) = 1.0;
  EXPECT_DOUBLE_EQ(tail(loop), 5.0);
}

TEST(Loop, TailOfShortLoopsLooksAtFourHarmonicsOrTwo) {
  Loop loop = constant_loop(std::vector<double>{1.0}, 1.0, 8);
  loop.cosine(4, 0) = 1.0;
  EXPECT_EQ(tail(loop), 0.0);
  loop.cosine(5, 0) = 0.5;
  EXPECT_EQ(tail(loop), 0.5);
  Loop shortest = constant_loop(std::vector<double>{1.0}, 1.0, 1);
  shortest.sine(1, 0) = -0.25;
  EXPECT_EQ(tail(shortest), 0.25);
}

TEST(LoopMisuse, ConstantLoop) {
  const std::vector<double> point{1.0, 2.0};
  EXPECT_THROW(static_cast<void>(constant_loop({}, 1.0, 4)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(constant_loop(point, 1.0, 0)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(constant_loop(point, 1.0, -3)), core::MisuseError);
  for (const double period : {0.0, -1.0, nan, inf})
    EXPECT_THROW(static_cast<void>(constant_loop(point, period, 4)), core::MisuseError) << period;
  EXPECT_THROW(static_cast<void>(constant_loop(std::vector<double>{1.0, nan}, 1.0, 4)), core::MisuseError);
}

TEST(LoopMisuse, ValidateRefusesWhatIsNoLoop) {
  const Loop good = random_loop(2, 3, 1);
  EXPECT_NO_THROW(validate(good));
  const auto refused = [&good](const std::function<void(Loop&)>& spoil) {
    Loop bad = good;
    spoil(bad);
    EXPECT_THROW(validate(bad), core::MisuseError);
  };
  refused([](Loop& l) { l.period = 0.0; });
  refused([](Loop& l) { l.period = -2.0; });
  refused([](Loop& l) { l.period = nan; });
  refused([](Loop& l) { l.period = inf; });
  refused([](Loop& l) { l.cutoff = 0; });
  refused([](Loop& l) { l.cutoff = 4; });
  refused([](Loop& l) { l.dimension = 0; });
  refused([](Loop& l) { l.dimension = 3; });
  refused([](Loop& l) { l.modes.pop_back(); });
  refused([](Loop& l) { l.winding.pop_back(); });
  refused([](Loop& l) { l.modes[5] = nan; });
  refused([](Loop& l) { l.modes[5] = -inf; });
  EXPECT_THROW(validate(Loop{}), core::MisuseError);
}

TEST(LoopMisuse, ChangesAndDistances) {
  const Loop loop = random_loop(2, 3, 1);
  EXPECT_THROW(static_cast<void>(with_cutoff(loop, 0)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(mean_distance(loop, random_loop(3, 3, 1))), core::MisuseError);
  Loop winding = loop;
  winding.winding[0] = 1.0;
  EXPECT_THROW(static_cast<void>(mean_distance(loop, winding)), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loop::loop_test
