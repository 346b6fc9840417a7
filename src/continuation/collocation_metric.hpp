#pragma once

#include <vector>

#include "orbweaver/equations/collocation.hpp"
#include "predictor.hpp"

/// How points on the fundamental domain are compared. A change of T counts in units of `period_unit`.
namespace orbweaver::continuation {

/// The inner product of the steps a - b and c - d: a mean over time, and the period.
[[nodiscard]] double step_product(const equations::Collocation& equations, const std::vector<double>& a,
                                  const std::vector<double>& b, const std::vector<double>& c,
                                  const std::vector<double>& d, double period_unit);

/// The change of a prediction orthogonal to its direction, and to the time shift where the domain has one.
[[nodiscard]] std::vector<double> step_conditions(const equations::Collocation& equations, const Prediction& prediction,
                                                  double period_unit);

/// Takes the time shift since `last` out of a prediction and its direction.
void take_out_shift(const equations::Collocation& equations, Prediction& prediction, const std::vector<double>& last);

/// True if the oscillation of one is the other's upside down.
[[nodiscard]] bool is_upside_down(const equations::Collocation& equations, const std::vector<double>& a,
                                  const std::vector<double>& b);

}  // namespace orbweaver::continuation
