#pragma once

#include <functional>
#include <optional>

namespace orbweaver::bifurcation {

/// A function of the position along a family; NaN where it has no value.
using PositionFunction = std::function<double(double position)>;

/// A located zero or minimum.
struct Located {
  double position = 0.0;
  double value = 0.0;  ///< of the function there
  double width = 0.0;  ///< of the interval that is left around it
  int evaluations = 0;
  bool converged = false;  ///< width <= tolerance, or an exact zero
};

/// The zero of `function` between `from` and `to`, where it has opposite signs, to `tolerance` in the position
/// (Alefeld, Potra and Shi's algorithm 748: bracketing, superlinear). None if the signs agree or a value is NaN.
/// Throws MisuseError unless from < to and tolerance > 0.
[[nodiscard]] std::optional<Located> locate_root(const PositionFunction& function, double from, double to,
                                                 double tolerance, int max_evaluations = 60);

/// A local minimum of `function` between `from` and `to` (Brent's method), to `tolerance` in the position, but not
/// closer than 1e-8 (to - from), where a minimum is flat to double precision. None if a value is NaN.
/// Throws MisuseError unless from < to and tolerance > 0.
[[nodiscard]] std::optional<Located> locate_minimum(const PositionFunction& function, double from, double to,
                                                    double tolerance, int max_evaluations = 60);

}  // namespace orbweaver::bifurcation
