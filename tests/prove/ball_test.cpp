#include "ball.hpp"

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::prove::ball_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Ball, HoldsTheDecimalNumberAndNotTheDoubleNextToIt) {
  const WorkingBits working(200);
  const Ball tenth = Ball::of_decimal("0.1");
  EXPECT_TRUE((tenth * Ball(10.0)).contains(Ball(1.0)));
  EXPECT_FALSE(tenth.contains(Ball(0.1)));
  EXPECT_LT(tenth.radius().upper(), 1e-59);
  EXPECT_LE(tenth.lower(), 0.1);
  EXPECT_GE(tenth.upper(), 0.1);
  EXPECT_TRUE(Ball::of_decimal("9").contains(Ball(9.0)));
  EXPECT_EQ(Ball::of_decimal("-2.5").upper(), -2.5);
  EXPECT_THAT([] { static_cast<void>(Ball::of_decimal("nine")); },
              ThrowsMessage<core::InputError>(HasSubstr("expected a decimal number")));
}

TEST(Ball, ComparesAllNumbersOfBoth) {
  const Ball one(1.0);
  const Ball about_one = one.widened(Ball(0.5));
  EXPECT_FALSE(about_one < one);
  EXPECT_FALSE(one < about_one);
  EXPECT_TRUE(about_one < Ball(1.6));
  EXPECT_FALSE(about_one < Ball(1.5));
  EXPECT_TRUE(about_one.contains(Ball(1.5)));
  EXPECT_FALSE(about_one.contains(Ball(1.5000001)));
  EXPECT_GE(about_one.modulus().lower(), 1.5);
}

TEST(Ball, IsNotFiniteWhereAnOperationIsNotDefined) {
  const Ball around = Ball(0.1).widened(Ball(0.2));
  EXPECT_FALSE((Ball(1.0) / around).is_finite());
  EXPECT_FALSE(sqrt(Ball(-1.0)).is_finite());
  EXPECT_FALSE(log(around).is_finite());
  EXPECT_TRUE(sqrt(Ball(2.0)).is_finite());
}

TEST(Ball, KeepsItsTextToTheLastBit) {
  const WorkingBits working(150);
  const Ball pi = Ball::pi();
  const Ball same = Ball::of_exact_text(pi.exact_text());
  EXPECT_TRUE(same.contains(pi) && pi.contains(same));
  EXPECT_THAT([] { static_cast<void>(Ball::of_exact_text("about 3")); },
              ThrowsMessage<core::InputError>(HasSubstr("expected a ball")));
  // Whose decimal digits would take all memory.
  EXPECT_THROW(static_cast<void>(Ball::of_exact_text("1 7fffffffffffffffff 0 0")), core::InputError);
  EXPECT_THROW(static_cast<void>(Ball::of_exact_text("1 0 1 fffffffffffffff")), core::InputError);
}

// The square root of a rectangle about i lies off the cut; of one about -1 it meets it, as does the logarithm.
TEST(ComplexBall, IsNotFiniteOnACut) {
  const Ball half = Ball::around_zero(Ball(0.5));
  const ComplexBall about_i(half, half + Ball(1.0));
  const ComplexBall about_minus_one(half - Ball(1.0), half);
  for (const auto& [value, finite] : {std::pair{about_i, true}, std::pair{about_minus_one, false}}) {
    EXPECT_EQ(sqrt(value).is_finite(), finite);
    EXPECT_EQ(log(value).is_finite(), finite);
  }
  EXPECT_FALSE((ComplexBall(1.0) / ComplexBall(half, half)).is_finite());
  EXPECT_FALSE(asin(about_i).is_finite());
  EXPECT_FALSE(acos(about_i).is_finite());
  EXPECT_FALSE(atan(about_i).is_finite());
  // |1/2 + 3/2 i| is the largest modulus of the first.
  EXPECT_GE(about_i.modulus().upper(), std::hypot(0.5, 1.5));
  EXPECT_LT(about_i.modulus().upper(), 1.0001 * std::hypot(0.5, 1.5));
}

TEST(BallMatrix, HoldsInversesAndGrowth) {
  BallMatrix a(2, 2);
  a.set(0, 0, Ball(1.0).widened(Ball(1e-3)));
  a.set(0, 1, Ball(2.0));
  a.set(1, 1, Ball(-0.5));
  const BallMatrix back = inverse(a);
  // ((1 + e, 2), (0, -1/2))^-1 = ((1/(1 + e), 4/(1 + e)), (0, -2))
  for (const double e : {-1e-3, 0.0, 1e-3}) {
    EXPECT_TRUE(back.at(0, 0).contains(Ball(1.0) / Ball(1.0 + e)));
    EXPECT_TRUE(back.at(0, 1).contains(Ball(4.0) / Ball(1.0 + e)));
  }
  EXPECT_TRUE(back.at(1, 1).contains(Ball(-2.0)));
  a.set(1, 1, Ball::around_zero(Ball(1.0)));
  EXPECT_THROW(static_cast<void>(inverse(a)), core::NumericalError);
  // exp((0, -t), (t, 0)) - 1 has entries cos t - 1 and sin t, below cosh t - 1 and sinh t.
  BallMatrix turn(2, 2);
  turn.set(0, 1, Ball(-0.5));
  turn.set(1, 0, Ball(0.5));
  const BallMatrix bound = growth_bound(turn);
  EXPECT_GE(bound.at(0, 0).lower(), std::cosh(0.5) - 1.0 - 1e-15);
  EXPECT_GE(bound.at(0, 1).lower(), std::sinh(0.5) - 1e-15);
}

}  // namespace
}  // namespace orbweaver::prove::ball_test
