#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "stepper.hpp"

namespace orbweaver::continuation {

/// An orbit whose quantity is so near to a limit, in parts of 1 + |limit|, lies on it where rounding lets none come
/// nearer.
inline constexpr double near_limit = 1e-10;

/// The orbit of a branch on a limit, or why there is none.
struct OnLimit {
  std::optional<Trial> trial;  ///< with its loop
  Ending ending;               ///< where there is none
};

/// A limit that was passed by the step of `length` to the trial `beyond`.
struct Passed {
  EndReason reason;         ///< the limit's
  std::string_view symbol;  ///< of what is limited, for messages: "T"
  double limit = 0.0;
  double length = 0.0;
  const Trial& beyond;
  double unit = 1.0;  ///< of the limit, for messages
  double size = 1.0;  ///< of what is limited, where the limit itself is smaller: how near to it an orbit lies on it
};

/// None, with why.
[[nodiscard]] OnLimit failure(const Passed& passed, std::string_view why);

/// The orbit that a prediction is corrected to, with as many harmonics as it needs: the branch's points have those
/// then.
[[nodiscard]] OnLimit orbit_from(Stepper& stepper, const Passed& passed, Prediction prediction,
                                 std::optional<int> held_scalar = std::nullopt);

/// The orbit between the last point and the one beyond whose scalar of this number is the limit, exactly.
[[nodiscard]] OnLimit orbit_at_scalar(Stepper& stepper, const Passed& passed, int scalar);

/// The orbit there at which a measured quantity, `from` at the last point, is the limit.
[[nodiscard]] OnLimit orbit_at_value(Stepper& stepper, const Passed& passed, double from,
                                     const std::function<double(const Trial&)>& quantity);

}  // namespace orbweaver::continuation
