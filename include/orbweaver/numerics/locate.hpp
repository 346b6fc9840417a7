#pragma once

#include <functional>
#include <optional>

namespace orbweaver::numerics {

/// A function of one variable; NaN where it has no value.
using Function = std::function<double(double position)>;

/// A value of a function, and where.
struct Place {
  double position = 0.0;
  double value = 0.0;
};

/// A located zero or minimum.
struct Located {
  double position = 0.0;
  double value = 0.0;  ///< of the function there
  double width = 0.0;  ///< of the interval that is left around it
  int evaluations = 0;
  bool converged = false;  ///< width <= tolerance, or an exact zero
};

/// The zero of `function` between `from` and `to`, where it has opposite signs, to `tolerance` in the position
/// (algorithm 748 of Alefeld, Potra and Shi, doi:10.1145/210089.210111: bracketing, superlinear). None if the signs
/// agree or a value is NaN; an end with the value 0 is the zero. A function that has come near enough may say 0.
/// Throws MisuseError unless from < to and tolerance > 0.
[[nodiscard]] std::optional<Located> locate_root(const Function& function, double from, double to, double tolerance,
                                                 int max_evaluations = 60);
/// The same where the values at the ends are known.
[[nodiscard]] std::optional<Located> locate_root(const Function& function, const Place& from, const Place& to,
                                                 double tolerance, int max_evaluations = 60);

/// A local minimum of `function` between `from` and `to` (Brent's method), to `tolerance` in the position, but not
/// closer than 1e-8 (to - from), where a minimum is flat to double precision. None if a value is NaN.
/// Throws MisuseError unless from < to and tolerance > 0.
[[nodiscard]] std::optional<Located> locate_minimum(const Function& function, double from, double to, double tolerance,
                                                    int max_evaluations = 60);

}  // namespace orbweaver::numerics
