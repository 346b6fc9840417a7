#include "orbweaver/loop/curve/passages.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::loop::passages_test {
namespace {

using test::two_pi;

/// (a cos s, -a sin s) with K harmonics, over a period of 3.
Loop circle(double amplitude, int cutoff = 6) {
  Loop loop = constant_loop(std::vector{0.0, 0.0}, 3.0, cutoff);
  loop.cosine(1, 0) = amplitude;
  loop.sine(1, 1) = -amplitude;
  return loop;
}

void expect_times(const std::vector<double>& found, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], tolerance) << n;
}

TEST(Passages, AreWhereACosineHasAValue) {
  const double third = std::acos(0.2 / 0.7) / two_pi * 3.0;
  expect_times(passages(circle(0.7), 0, 0.2, false), {third, 3.0 - third}, 1e-14);
  expect_times(passages(circle(0.7), 0, 0.8, false), {}, 0.0);
}

TEST(Passages, TakeTheTimeFromTheTimeMap) {
  const Loop even = circle(0.7, 40);
  const std::vector<double> expected = passages(even, 0, 0.2, false);
  for (const TimeMap& map : {TimeMap{1.7, {}}, TimeMap{1.0, {0.4, -0.2, 0.0, 0.1}}})
    expect_times(passages(with_time_map(even, map, 120), 0, 0.2, false), expected, 1e-12);
}

TEST(Passages, AtTheStartStayThereWhateverTheirRounding) {
  Loop loop = circle(0.7);
  for (const double offset : {0.0, 1e-17, -1e-17, 3e-16, -3e-16}) {
    loop.cosine(0, 1) = offset;
    const std::vector<double> times = passages(loop, 1, 0.0, false);
    ASSERT_EQ(times.size(), 2u) << offset;
    EXPECT_EQ(times[0], 0.0) << offset;
    EXPECT_NEAR(times[1], 1.5, 1e-14) << offset;
  }
}

TEST(Passages, SeeTwoThatLieBetweenNodes) {
  const double shift = 0.0123;  // of a period: the maximum lies between nodes
  const double way = std::sqrt(2e-9) / two_pi * 3.0;
  const Loop loop = time_shifted(circle(1.0), 1.0 - shift);
  expect_times(passages(loop, 0, 1.0 - 1e-9, false), {3.0 * shift - way, 3.0 * shift + way}, 1e-7 * way + 1e-11);
}

TEST(Passages, DoNotCountWhatTouchesOrRests) {
  expect_times(passages(circle(0.5), 0, 0.5, false), {}, 0.0);
  Loop flat = constant_loop(std::vector{0.0, 0.3, 0.0}, 3.0, 6);
  flat.cosine(1, 0) = 1.0;
  flat.sine(2, 2) = 1e-15;
  expect_times(passages(flat, 1, 0.3, false), {}, 0.0);
  expect_times(passages(flat, 2, 0.0, false), {}, 0.0);
}

TEST(Passages, OfAnglesAreModuloATurn) {
  Loop loop = constant_loop(std::vector{0.0}, two_pi, 4);
  loop.sine(1, 0) = 0.3;
  loop.winding[0] = 1.0;
  for (const double value : {1.0, 1.0 + two_pi, 1.0 - 3.0 * two_pi}) {
    const std::vector<double> times = passages(loop, 0, value, true);
    ASSERT_EQ(times.size(), 1u);
    EXPECT_NEAR(times[0] + 0.3 * std::sin(times[0]), 1.0, 1e-14);
  }
  loop.winding[0] = -2.0;
  EXPECT_EQ(passages(loop, 0, 1.0, true).size(), 2u);
  // A libration past the top, seen from below.
  Loop swing = constant_loop(std::vector{0.0}, two_pi, 4);
  swing.cosine(1, 0) = 3.5;
  EXPECT_EQ(passages(swing, 0, 3.0, true).size(), 4u);
  EXPECT_EQ(passages(swing, 0, 3.0, false).size(), 2u);
}

TEST(Passages, RefuseACoordinateThatIsNotThere) {
  EXPECT_THROW((void)passages(circle(1.0), 2, 0.0, false), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loop::passages_test
