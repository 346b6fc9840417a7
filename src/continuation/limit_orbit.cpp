#include "limit_orbit.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace orbweaver::continuation {

namespace {

OnLimit failure(const Passed& passed, std::string_view why) {
  return {std::nullopt,
          {EndReason::failure, fmt::format("no orbit at the {} {} = {:.6g}: {}", name_of(passed.reason), passed.symbol,
                                           passed.limit, why)}};
}

/// Where the polynomial through the last points and the one beyond has the limit.
Prediction predicted_at_scalar(const Stepper& stepper, const Passed& passed, std::size_t at) {
  std::vector<TracePoint> points = stepper.frontier().points;
  double low = points.back().parameter;
  points.push_back({passed.beyond.values, points.back().parameter + passed.length});
  double high = points.back().parameter;
  const int order = stepper.options().predictor_order;
  for (int n = 0; n < 60 && high - low > 1e-14 * high; ++n) {
    const double middle = 0.5 * (low + high);
    (extrapolate(points, order, middle).values[at] > passed.limit ? high : low) = middle;
  }
  Prediction prediction = extrapolate(points, order, low);
  prediction.values[at] = passed.limit;
  return prediction;
}

}  // namespace

OnLimit orbit_at_scalar(Stepper& stepper, const Passed& passed, int scalar) {
  Prediction prediction =
      predicted_at_scalar(stepper, passed, stepper.problem().scalars_at() + static_cast<std::size_t>(scalar));
  stepper.begin();
  while (true) {
    Trial trial = stepper.correct(prediction, scalar);
    if (!stepper.needs_more_harmonics(trial)) {
      if (!trial.is_orbit) return failure(passed, trial.reason);
      trial.values[stepper.problem().scalars_at() + static_cast<std::size_t>(scalar)] = passed.limit;
      return {std::move(trial), {}};
    }
    const std::optional<PointProblem::Transfer> finer = stepper.refine(trial);
    if (!finer)
      return {std::nullopt,
              {EndReason::cutoff_limit, fmt::format("the orbit at {} = {:.6g} needs more than K = {}", passed.symbol,
                                                    passed.limit, stepper.options().cutoff_to)}};
    prediction.values = (*finer)(prediction.values);
    prediction.tangent = (*finer)(prediction.tangent);
  }
}

OnLimit orbit_at_value(Stepper& stepper, const Passed& passed, double from,
                       const std::function<double(const Trial&)>& quantity) {
  stepper.begin();
  double low = 0.0;
  double low_value = from - passed.limit;
  double high = passed.length;
  double high_value = quantity(passed.beyond) - passed.limit;
  const double scale = 1.0 + std::abs(passed.limit);
  Trial trial;
  bool found = false;
  for (int n = 0; n < 60 && (!found || std::abs(high_value) > 1e-13 * scale); ++n) {
    const double middle = (low * high_value - high * low_value) / (high_value - low_value);
    trial = stepper.step(middle);
    found = !stepper.needs_more_harmonics(trial);
    if (!found) {
      if (!stepper.refine(trial))
        return {std::nullopt,
                {EndReason::cutoff_limit,
                 fmt::format("the next orbit needs more than K = {}", stepper.options().cutoff_to)}};
      continue;
    }
    if (!trial.is_orbit) return failure(passed, trial.reason);
    const double value = quantity(trial) - passed.limit;
    if ((value > 0.0) != (high_value > 0.0)) {
      low = high;
      low_value = high_value;
    } else {
      low_value *= 0.5;
    }
    high = middle;
    high_value = value;
  }
  if (!found || std::abs(high_value) > 1e-10 * scale)
    return failure(passed, fmt::format("the bracket ends {:.1e} beside it", high_value));
  return {std::move(trial), {}};
}

}  // namespace orbweaver::continuation
