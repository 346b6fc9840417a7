#include "orbweaver/numerics/locate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::numerics {

namespace {

/// Brent's method finds a minimum no closer than the square root of rounding, and half the bracket is no search.
constexpr double least_share = 1e-8;
constexpr double largest_share = 0.5;

/// Of a smooth function: places that an interpolation takes, interpolations that are tried, how far each must bring the
/// value down, and how near the zero must be, in parts of the tolerance. Zeros of indices take three or four.
constexpr std::size_t interpolated = 4;
constexpr int most_interpolations = 8;
constexpr double converging = 0.1;
constexpr double settled = 0.01;

struct NoValue {};

/// Counts evaluations, and leaves the library's algorithm where there is no value.
struct Counted {
  const Function& function;
  int evaluations = 0;

  double operator()(double position) {
    core::interruption_point();
    ++evaluations;
    const double value = function(position);
    if (std::isnan(value)) throw NoValue{};
    return value;
  }
};

void check_interval(double from, double to, double tolerance) {
  core::require(from < to && tolerance > 0.0, "location needs an interval with from < to and a tolerance > 0");
}

}  // namespace

std::optional<Located> locate_root(const Function& function, double from, double to, double tolerance,
                                   int max_evaluations) {
  check_interval(from, to, tolerance);
  const Place low{from, function(from)};
  const Place high{to, function(to)};
  std::optional<Located> root = locate_root(function, low, high, tolerance, max_evaluations - 2);
  if (root) root->evaluations += 2;
  return root;
}

std::optional<Located> locate_root(const Function& function, const Place& from, const Place& to, double tolerance,
                                   int max_evaluations) {
  check_interval(from.position, to.position, tolerance);
  if (std::isnan(from.value) || std::isnan(to.value)) return std::nullopt;
  if (from.value == 0.0) return Located{from.position, 0.0, 0.0, 0, true};
  if (to.value == 0.0) return Located{to.position, 0.0, 0.0, 0, true};
  if (std::signbit(from.value) == std::signbit(to.value)) return std::nullopt;
  Place best = std::abs(to.value) < std::abs(from.value) ? to : from;
  Counted counted{function};
  const auto watched = [&](double position) {
    const double value = counted(position);
    if (std::abs(value) < std::abs(best.value)) best = {position, value};
    return value;
  };
  const auto close = [tolerance](double a, double b) { return std::abs(b - a) <= tolerance; };
  auto budget = static_cast<std::uintmax_t>(std::max(1, max_evaluations));
  try {
    const auto [a, b] =
        boost::math::tools::toms748_solve(watched, from.position, to.position, from.value, to.value, close, budget);
    return Located{best.position, best.value, b - a, counted.evaluations, close(a, b)};
  } catch (const NoValue&) {
    return std::nullopt;
  }
}

namespace {

/// Where the function vanishes by the polynomial for the position as a function of the value, through the nearest.
double by_inverse_interpolation(std::vector<Place> places) {
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return std::abs(a.value) < std::abs(b.value); });
  places.resize(std::min(places.size(), interpolated));
  std::vector<double> values;
  for (const Place& place : places) values.push_back(place.value);
  const std::vector<double> weights = lagrange_weights(values, 0.0).value;
  double position = 0.0;
  for (std::size_t n = 0; n < places.size(); ++n) position += weights[n] * places[n].position;
  return position;  // not finite where two values agree
}

}  // namespace

std::optional<Located> locate_smooth_root(const Function& function, const Place& from, const Place& to,
                                          double tolerance, int max_evaluations) {
  check_interval(from.position, to.position, tolerance);
  if (!(from.value * to.value < 0.0)) return locate_root(function, from, to, tolerance, max_evaluations);
  std::vector<Place> places{from, to};
  Place low = from;
  Place high = to;
  Place best = std::abs(to.value) < std::abs(from.value) ? to : from;
  int evaluations = 0;
  while (evaluations < std::min(most_interpolations, max_evaluations)) {
    core::interruption_point();
    const double position = by_inverse_interpolation(places);
    if (!(position > low.position && position < high.position)) break;
    ++evaluations;
    const Place here{position, function(position)};
    if (std::isnan(here.value)) break;  // it may have one wherever the other algorithm looks
    const double slope = (here.value - best.value) / (here.position - best.position);
    const double off = std::abs(here.value / slope);
    if (here.value == 0.0 || (std::abs(here.value) < converging * std::abs(best.value) && off <= settled * tolerance))
      return Located{position, here.value, here.value == 0.0 ? 0.0 : off, evaluations, true};
    places.push_back(here);
    (std::signbit(here.value) == std::signbit(low.value) ? low : high) = here;
    if (std::abs(here.value) > converging * std::abs(best.value) && evaluations > 1) break;
    if (std::abs(here.value) < std::abs(best.value)) best = here;
  }
  std::optional<Located> root = locate_root(function, low, high, tolerance, max_evaluations - evaluations);
  if (root) root->evaluations += evaluations;
  return root;
}

std::optional<Located> locate_minimum(const Function& function, double from, double to, double tolerance,
                                      int max_evaluations) {
  check_interval(from, to, tolerance);
  Counted counted{function};
  const double length = to - from;
  const double share = std::clamp(tolerance / length, least_share, largest_share);
  // The library's tolerance is relative to the position, here a number in [0, 1].
  const int bits = 1 + static_cast<int>(std::ceil(-std::log2(share)));
  auto budget = static_cast<std::uintmax_t>(std::max(1, max_evaluations - 1));
  const std::uintmax_t given = budget;
  try {
    const auto [t, value] = boost::math::tools::brent_find_minima(
        [&](double u) { return counted(u == 1.0 ? to : from + u * length); }, 0.0, 1.0, bits, budget);
    return Located{t == 1.0 ? to : from + t * length, value, share * length, counted.evaluations, budget < given};
  } catch (const NoValue&) {
    return std::nullopt;
  }
}

}  // namespace orbweaver::numerics
