#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// A time shift psi at which the mean square D^2 of y(t + psi) - x(t), angles modulo 2 pi, has a local minimum.
struct ShiftMinimum {
  double shift = 0.0;   ///< psi in periods; not reduced
  double square = 0.0;  ///< D^2, from correlations: to rounding of |x|^2 + |y|^2
};

/// The local minima, closest first, to rounding in psi (Newton's method on d D^2/d psi from a grid finer than the
/// harmonics). Both loops run evenly in time and wind alike. With y_k, x_k the complex coefficients,
/// D^2 = |mean y + 2 pi psi n - mean x|^2 + (1/2) sum_k |y_k e^{2 pi i k psi} - x_k|^2.
[[nodiscard]] std::vector<ShiftMinimum> shift_minima(const Loop& y, const Loop& x, const std::vector<int>& angles);

/// The local minimum that Newton's method finds from `shift`.
[[nodiscard]] ShiftMinimum shift_minimum_near(const Loop& y, const Loop& x, const std::vector<int>& angles,
                                              double shift);

/// y(t + psi) - x(t), angles' means reduced to [-pi, pi]: no winding. `turns`, if given, takes the whole turns added to
/// y.
[[nodiscard]] Loop difference_at(const Loop& y, const Loop& x, const std::vector<int>& angles, double shift,
                                 std::vector<double>* turns = nullptr);

}  // namespace orbweaver::loop
