#include "orbweaver/numerics/locate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::numerics {

namespace {

/// Brent's method finds a minimum no closer than the square root of rounding, and half the bracket is no search.
constexpr double least_share = 1e-8;
constexpr double largest_share = 0.5;

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
