#include "place_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "orbweaver/continuation/orbit.hpp"

namespace orbweaver::bifurcation {

namespace {

/// The factor to which an enclosure is found: bounds of errors are good to no less.
constexpr double resolved = 2.0;
/// Where what turns is asked how it scatters, in parts of the bracket: so near it is a straight line to 1e-12.
constexpr std::array scatter_shares{1e-6, 2e-6};

struct SideOfZero {
  double distance;
  bool is_told;
};

SideOfZero side_of_zero(const BoundedFunction& function, const std::vector<double>& asked, double place, double end,
                        double least) {
  const double direction = end > place ? 1.0 : -1.0;
  SideOfZero told{std::abs(end - place), false};
  // Rounding may bring the whole distance beyond the end, where nothing is known.
  const auto position_at = [&](double distance) {
    const double position = place + direction * distance;
    return direction > 0.0 ? std::min(position, end) : std::max(position, end);
  };
  const double error = function(place).error;
  double share = 1.0;  // the error's of the value there
  double untold = 0.0;
  std::vector<double> distances{told.distance};
  for (const double position : asked)
    if (direction * (position - place) > 0.0 && direction * (end - position) > 0.0)
      distances.push_back(direction * (position - place));
  std::sort(distances.begin(), distances.end());
  int sign = 0;
  for (std::size_t n = distances.size(); n > 0 && sign == 0; --n) sign = function(position_at(distances[n - 1])).sign();
  if (sign == 0) return told;
  // Whether the sign is told so far from the place.
  const auto ask = [&](double distance) {
    const Reading reading = function(position_at(distance));
    const bool is_told = reading.sign() == sign;
    if (is_told) {
      told = {distance, true};
      share = std::fmin(error, reading.error) / std::abs(reading.value);
    }
    return is_told;
  };
  for (const double distance : distances) {
    if (ask(distance)) break;
    untold = distance;
  }
  // A smooth function goes to zero no slower than with the distance: nearer than that it cannot be told.
  untold = std::max(untold, share * told.distance);
  for (double next = std::max(least, resolved * untold); told.distance > least && told.distance > resolved * untold;
       next = std::sqrt(untold * told.distance))
    if (next >= told.distance || !ask(next)) untold = next;
  return told;
}

/// Of what turns at a fold the slope has no bound: what it differs by from a straight line so near to the place. What
/// is left of its own digits is more.
double scatter_of(const BoundedFunction& function, double place, const Interval& within) {
  const double there = function(place).value;
  double scatter = std::numeric_limits<double>::epsilon() *
                   std::max(std::abs(function(within.from).value), std::abs(function(within.to).value));
  for (const double share : scatter_shares) {
    const double away = share * (within.to - within.from);
    if (place - away < within.from || place + away > within.to) continue;
    const double middle = 0.5 * (function(place - away).value + function(place + away).value);
    if (!std::isnan(middle)) scatter = std::max(scatter, std::abs(middle - there));
  }
  return scatter;
}

/// The most that a quantity differs from what it is at the place, where it differs by `values` at `distances` (both
/// signs), and between these as the parabola through the outermost two and the place.
double most_change(const std::vector<double>& distances, const std::vector<double>& values) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) most = std::fmax(most, std::abs(value));
  if (distances.size() < 2 || std::isnan(most)) return most;
  const double a = distances.front(), b = distances.back();
  const double at_a = values.front(), at_b = values.back();
  if (!(a < 0.0 && b > 0.0)) return most;
  const double slope = (at_a * b / a - at_b * a / b) / (b - a);
  const double curvature = (at_b / b - at_a / a) / (b - a);
  const double turn = -0.5 * slope / curvature;
  return turn > a && turn < b ? std::fmax(most, std::abs(0.5 * slope * turn)) : most;
}

}  // namespace

Enclosure enclosure_of_zero(const BoundedFunction& function, const std::vector<double>& asked, double place,
                            double from, double to, double least) {
  const SideOfZero before = side_of_zero(function, asked, place, from, least);
  const SideOfZero behind = side_of_zero(function, asked, place, to, least);
  return {before.distance, behind.distance, before.is_told && behind.is_told};
}

Enclosure enclosure_of_fold(EventFunction& slope, double place, const Interval& within, double least) {
  const BoundedFunction slope_at = [&](double position) { return slope.reading(position); };
  const double of_slope = scatter_of(slope_at, place, within);
  const Enclosure found = enclosure_of_zero(
      [&](double position) {
        return Reading{slope_at(position).value, of_slope};
      },
      slope.asked(), place, within.from, within.to, least);
  if (found.is_told) return found;
  // Located as an extremum, where slopes do not tell.
  const double there = slope.turning_at(place);
  const BoundedFunction change = [&](double position) { return Reading{slope.turning_at(position) - there, 0.0}; };
  const double rounding =
      std::max(scatter_of(change, place, within), std::numeric_limits<double>::epsilon() * std::abs(there));
  return enclosure_of_zero(
      [&](double position) {
        return Reading{change(position).value, rounding};
      },
      slope.asked(), place, within.from, within.to, least);
}

PlaceError place_error(const EventFunction& function, const continuation::FamilyCurve& family, double place,
                       const EventFunction::Levels& there, const Enclosure& enclosure) {
  PlaceError error;
  error.arclength = std::max(enclosure.before, enclosure.behind) * std::abs(family.arclength_unit_at(place));
  std::vector<double> distances;
  std::array<std::vector<double>, 3> changes;
  // Positions and distances differ by rounding.
  const double rounding =
      2.0 * std::numeric_limits<double>::epsilon() * (std::abs(place) + enclosure.before + enclosure.behind);
  const auto& seen = function.seen();
  for (auto other = seen.lower_bound(place - enclosure.before - rounding);
       other != seen.end() && other->first <= place + enclosure.behind + rounding; ++other) {
    distances.push_back(other->first - place);
    for (std::size_t n = 0; n < changes.size(); ++n) changes[n].push_back(other->second[n] - there[n]);
  }
  error.period = most_change(distances, changes[0]);
  error.energy = most_change(distances, changes[1]);
  error.parameter = most_change(distances, changes[2]);
  return error;
}

}  // namespace orbweaver::bifurcation
