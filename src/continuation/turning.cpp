#include "turning.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::continuation {

std::optional<double> turning_outside(const CourseOverStep& course, double low, double high) {
  if (!(course.slope_from * course.slope_to < 0.0)) return std::nullopt;
  // from + s (slope_from + s (second + s third)) has one place inside where it turns.
  const double rise = course.to - course.from;
  const double third = course.slope_from + course.slope_to - 2.0 * rise;
  const double second = rise - course.slope_from - third;
  const double root = std::sqrt(std::max(0.0, second * second - 3.0 * third * course.slope_from));
  const double place = -course.slope_from / (second + std::copysign(root, second));
  const double other = (second + std::copysign(root, second)) / (-3.0 * third);
  for (const double s : {place, other}) {
    if (!(s > 0.0 && s < 1.0)) continue;
    const double value = course.from + s * (course.slope_from + s * (second + s * third));
    if (value > high || value < low) return s;
  }
  return std::nullopt;
}

}  // namespace orbweaver::continuation
