#pragma once

#include <limits>
#include <vector>

#include "orbweaver/equations/collocation.hpp"
#include "predictor.hpp"

/// How points on the fundamental domain are compared. A change of T counts in units of `period_unit`.
namespace orbweaver::continuation {

/// The inner product of the steps a - b and c - d: a mean over time, and the period.
[[nodiscard]] double step_product(const equations::Collocation& equations, const std::vector<double>& a,
                                  const std::vector<double>& b, const std::vector<double>& c,
                                  const std::vector<double>& d, double period_unit);

/// The change of a prediction orthogonal to its direction, what the family holds, and the change orthogonal to the time
/// shift where the domain has one, then to the direction across where there is one.
[[nodiscard]] std::vector<double> step_conditions(const equations::Collocation& equations, const Prediction& prediction,
                                                  double period_unit);

/// Roundings of nodal values after a filter over the whole loop and the elimination. Not measured.
inline constexpr double nodal_rounding = 50.0 * std::numeric_limits<double>::epsilon();

/// What rounding leaves of the residual: as of a loop, but for what the elimination leaves in the nodal values, which
/// the field's Jacobian multiplies: beside a motion a thousand times as fast that is most of it (m2 = 1e6).
[[nodiscard]] double rounding_floor(const equations::Collocation& equations,
                                    const equations::Collocation::Quality& quality, double period);

/// Takes the time shift since `last` out of a prediction and its direction.
void take_out_shift(const equations::Collocation& equations, Prediction& prediction, const std::vector<double>& last);

/// True if the oscillation of one is the other's upside down.
[[nodiscard]] bool is_upside_down(const equations::Collocation& equations, const std::vector<double>& a,
                                  const std::vector<double>& b);

}  // namespace orbweaver::continuation
