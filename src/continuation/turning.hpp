#pragma once

#include <optional>

namespace orbweaver::continuation {

/// A quantity along a step: its values at both ends and how it changes there, by the step's length.
struct CourseOverStep {
  double from = 0.0;
  double to = 0.0;
  double slope_from = 0.0;
  double slope_to = 0.0;
};

/// Where within the step (0 to 1) the quantity turns outside [low, high], its ends lying inside, by the cubic with
/// these values and slopes. None where it does not.
[[nodiscard]] std::optional<double> turning_outside(const CourseOverStep& course, double low, double high);

}  // namespace orbweaver::continuation
