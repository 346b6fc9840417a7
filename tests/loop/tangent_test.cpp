// A tangent moves modes and scalars together: the same difference, the same length, whatever the loop's cutoff and time
// map.
#include "orbweaver/loop/curve/tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace tangent_test {
namespace {

using namespace orbweaver;
using loop::Tangent;

loop::Loop base() {
  loop::Loop out = loop::constant_loop(std::vector<double>{0.3, -1.0}, 5.0, 3);
  out.cosine(1, 0) = 0.7;
  out.sine(2, 1) = -0.4;
  out.winding = {1.0, 0.0};
  return out;
}

Tangent sample(int cutoff = 3) {
  Tangent out{std::vector<double>((2 * static_cast<std::size_t>(cutoff) + 1) * 2, 0.0), {0.25, -2.0}};
  for (std::size_t n = 0; n < 14; ++n) out.modes[n] = std::sin(1.0 + static_cast<double>(n));
  return out;
}

TEST(Tangent, IsEmptyUntilItIsKnown) {
  EXPECT_TRUE(Tangent{}.empty());
  EXPECT_EQ(Tangent{}.period(), 0.0);
  EXPECT_FALSE(sample().empty());
}

TEST(Tangent, MeasuresModesAndScalars) {
  Tangent t = sample();
  double square = 0.25 * 0.25 + 4.0;
  for (const double v : t.modes) square += v * v;
  EXPECT_NEAR(t.norm(), std::sqrt(square), 1e-15 * square);
  t *= -3.0;
  EXPECT_NEAR(loop::dot(t, sample()), -3.0 * square, 1e-14 * square);
  EXPECT_EQ(t.period(), -0.75);
  EXPECT_EQ(t.scalars[1], 6.0);
  t.normalize();
  EXPECT_NEAR(t.norm(), 1.0, 1e-15);
  EXPECT_LT(t.period(), 0.0);
  // A scalar that one of the two leaves out does not change.
  EXPECT_NEAR(loop::dot(Tangent{sample().modes, {}}, sample()), square - 0.0625 - 4.0, 1e-14 * square);
  Tangent zero{std::vector<double>(14, 0.0), {0.0}};
  EXPECT_THROW(zero.normalize(), core::MisuseError);
  EXPECT_THROW(static_cast<void>(loop::dot(sample(), sample(4))), core::MisuseError);
}

TEST(Tangent, KeepsItsLengthWithMoreHarmonics) {
  const Tangent more = loop::with_cutoff(sample(), 7, 2);
  EXPECT_EQ(more.modes.size(), 30U);
  EXPECT_EQ(more.norm(), sample().norm());
  EXPECT_EQ(loop::with_cutoff(more, 3, 2), sample());
}

TEST(Tangent, MovesALoop) {
  const loop::Loop moved = loop::moved(base(), sample(), 0.5);
  EXPECT_EQ(moved.period, 5.125);
  EXPECT_EQ(moved.winding, base().winding);
  for (std::size_t n = 0; n < moved.modes.size(); ++n)
    EXPECT_EQ(moved.modes[n], base().modes[n] + 0.5 * sample().modes[n]);
  EXPECT_THROW(static_cast<void>(loop::moved(base(), sample(4), 0.5)), core::MisuseError);
  const std::vector<double> from = loop::state_at(base(), 0.0);
  const std::vector<double> to = loop::state_at(moved, 0.0);
  EXPECT_NEAR(std::hypot(to[0] - from[0], to[1] - from[1]), 0.5 * loop::change_at_start(base(), sample()), 1e-14);
}

// Move and go around, or go around and move: the same loop. The same under a time map.
TEST(Tangent, GoesAroundWithItsLoop) {
  const loop::Loop one = loop::repeated(loop::moved(base(), sample(), 1.0), 3);
  const loop::Loop other = loop::moved(loop::repeated(base(), 3), loop::repeated(base(), sample(), 3), 1.0);
  EXPECT_NEAR(one.period, other.period, 1e-14);
  EXPECT_LT(loop::mean_distance(one, other), 1e-14);
  EXPECT_EQ(loop::repeated(base(), sample(), 3).scalars[1], -2.0);

  const loop::TimeMap map{1.5, {}};
  const loop::Loop mapped = loop::with_time_map(loop::moved(base(), sample(), 1.0), map, 40);
  const loop::Loop moved =
      loop::moved(loop::with_time_map(base(), map, 40), loop::with_time_map(base(), sample(), map, 40), 1.0);
  EXPECT_LT(loop::mean_distance(mapped, moved), 1e-12);
}

}  // namespace
}  // namespace tangent_test
