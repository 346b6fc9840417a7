#include "limit_orbit.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::continuation {

namespace {

/// Width of a bracket that is left, in parts of the position: rounding.
constexpr double position_width = 1e-14;
/// An orbit whose quantity is so near to a limit, in parts of the size + |limit|, lies on it.
constexpr double on_limit = 1e-13;

/// Where the polynomial through the last points and the one beyond has the limit.
Prediction predicted_at_scalar(const Stepper& stepper, const Passed& passed, std::size_t at) {
  std::vector<TracePoint> points = stepper.frontier().points;
  const double last = points.back().parameter;
  points.push_back({passed.beyond.values, last + passed.length});
  const int order = stepper.options().predictor_order;
  const auto root = numerics::locate_root(
      [&](double parameter) { return extrapolate(points, order, parameter).values[at] - passed.limit; }, last,
      last + passed.length, position_width * (last + passed.length));
  core::require(root.has_value(), "a limit that a step has passed lies between its ends");
  Prediction prediction = extrapolate(points, order, root->position);
  prediction.values[at] = passed.limit;
  return prediction;
}

}  // namespace

OnLimit failure(const Passed& passed, std::string_view why) {
  return {std::nullopt,
          {EndReason::failure, fmt::format("no orbit at the {} {} = {:.6g}: {}", name_of(passed.reason), passed.symbol,
                                           passed.limit * passed.unit, why)}};
}

OnLimit orbit_at_scalar(Stepper& stepper, const Passed& passed, int scalar) {
  const std::size_t at = stepper.problem().scalars_at() + static_cast<std::size_t>(scalar);
  OnLimit found = orbit_from(stepper, passed, predicted_at_scalar(stepper, passed, at), scalar);
  if (found.trial)
    found.trial->values[stepper.problem().scalars_at() + static_cast<std::size_t>(scalar)] = passed.limit;
  return found;
}

OnLimit orbit_from(Stepper& stepper, const Passed& passed, Prediction prediction, std::optional<int> held_scalar) {
  stepper.begin();
  while (true) {
    Trial trial = stepper.correct(prediction, held_scalar);
    if (!stepper.needs_more_harmonics(trial))
      return trial.is_orbit ? OnLimit{std::move(trial), {}} : failure(passed, trial.reason);
    const std::optional<PointProblem::Transfer> finer = stepper.refine(trial);
    if (!finer)
      return {std::nullopt,
              {EndReason::cutoff_limit, fmt::format("the orbit at {} = {:.6g} needs more than K = {}", passed.symbol,
                                                    passed.limit * passed.unit, stepper.options().cutoff_to)}};
    prediction.values = (*finer)(prediction.values);
    prediction.tangent = (*finer)(prediction.tangent);
  }
}

OnLimit orbit_at_value(Stepper& stepper, const Passed& passed, double from,
                       const std::function<double(const Trial&)>& quantity) {
  stepper.begin();
  const double scale = 1.0 + std::abs(passed.limit);
  double nearest = std::numeric_limits<double>::infinity();
  OnLimit found;
  std::optional<OnLimit> failed;
  const auto excess = [&](double length) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Trial trial = stepper.step(length);
    while (stepper.needs_more_harmonics(trial)) {
      if (!stepper.refine(trial)) {
        failed = {std::nullopt,
                  {EndReason::cutoff_limit,
                   fmt::format("the next orbit needs more than K = {}", stepper.options().cutoff_to)}};
        return none;
      }
      trial = stepper.step(length);
    }
    if (!trial.is_orbit) {
      failed = failure(passed, trial.reason);
      return none;
    }
    const double value = quantity(trial) - passed.limit;
    if (std::abs(value) < nearest) {
      nearest = std::abs(value);
      found.trial = std::move(trial);
    }
    return std::abs(value) <= on_limit * (passed.size + std::abs(passed.limit)) ? 0.0 : value;
  };
  (void)numerics::locate_root(excess, {0.0, from - passed.limit},
                              {passed.length, quantity(passed.beyond) - passed.limit}, position_width * passed.length);
  if (failed) return *std::move(failed);
  if (!(nearest <= near_limit * scale))
    return failure(passed, fmt::format("the nearest orbit is {:.1e} beside it", nearest));
  return found;
}

}  // namespace orbweaver::continuation
