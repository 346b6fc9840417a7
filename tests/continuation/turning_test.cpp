// Where a quantity turns within a step.
#include "turning.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace orbweaver::continuation::turning_test {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// value + s (slope + s (second + s third))
CourseOverStep course_of(double value, double slope, double second, double third) {
  return {value, value + slope + second + third, slope, slope + 2.0 * second + 3.0 * third};
}

TEST(Turning, OfAParabolaIsItsVertex) {
  const CourseOverStep rises_first = course_of(1.0, 0.6, -1.0, 0.0);  // 1.09 at 0.3
  ASSERT_TRUE(turning_outside(rises_first, -unlimited, 1.08).has_value());
  EXPECT_NEAR(*turning_outside(rises_first, -unlimited, 1.08), 0.3, 1e-15);
  EXPECT_FALSE(turning_outside(rises_first, -unlimited, 1.1).has_value());
  EXPECT_FALSE(turning_outside(rises_first, -unlimited, unlimited).has_value());
  const CourseOverStep falls_first = course_of(-1.0, -0.6, 1.0, 0.0);
  ASSERT_TRUE(turning_outside(falls_first, -1.08, unlimited).has_value());
  EXPECT_NEAR(*turning_outside(falls_first, -1.08, unlimited), 0.3, 1e-15);
}

TEST(Turning, OfACubicIsWhereItsSlopeVanishes) {
  for (const double third : {-0.3, -1e-9, 1e-9, 0.2, 0.5})
    for (const double place : {0.1, 0.5, 0.9}) {
      // The slope (s - place) (3 third s + rest), rest such that no other zero lies inside.
      const double rest = -2.0;
      const CourseOverStep course = course_of(0.0, -place * rest, 0.5 * (rest - 3.0 * third * place), third);
      SCOPED_TRACE(testing::Message() << third << " at " << place);
      ASSERT_TRUE(turning_outside(course, -unlimited, 0.0).has_value());
      EXPECT_NEAR(*turning_outside(course, -unlimited, 0.0), place, 1e-12);
    }
}

TEST(Turning, IsNoneWhereTheQuantityGoesOneWay) {
  EXPECT_FALSE(turning_outside(course_of(0.0, 1.0, 0.1, 0.1), -0.5, 0.5).has_value());
  EXPECT_FALSE(turning_outside(course_of(0.0, 0.0, 0.0, 0.0), -0.5, 0.5).has_value());
}

}  // namespace
}  // namespace orbweaver::continuation::turning_test
