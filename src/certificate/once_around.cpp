#include "once_around.hpp"

#include <algorithm>
#include <cmath>

#include "explained.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::certificate {

namespace {

/// Of the orbit's reach: where it returns by no more, what a displacement grows to is not asked for. So far off every
/// orbit may return (verdict.cpp).
constexpr double far_return = unexplained * integration_error;
/// Of the reach: by how much a state is displaced to see it, a hundred times what the integrator's tolerance leaves.
constexpr double displaced = 1e-11;

/// The most that a displacement of one coordinate at one of the instants t_m has grown by T, by products of
/// differences over the segments: an error that is made on the way grows from there, and beside what repels orbits by
/// far more than one that is made at their start.
double growth_on_the_way(const Trip& trip, double size) {
  const std::size_t d = trip.states.front().size();
  States beside;
  for (std::size_t m = 0; m + 1 < trip.states.size(); ++m) {
    beside.push_back(trip.states[m]);
    for (std::size_t i = 0; i < d; ++i) beside.emplace_back(trip.states[m])[i] += size;
  }
  const States ends = integrate_together(trip.system, beside, trip.period / static_cast<double>(trip.states.size() - 1),
                                         trip.tolerance);
  const auto rows = static_cast<Eigen::Index>(d);
  Eigen::MatrixXd to_end = Eigen::MatrixXd::Identity(rows, rows);
  double most = 0.0;
  for (std::size_t first = ends.size(); first > 0;) {
    first -= d + 1;
    Eigen::MatrixXd over_segment(rows, rows);
    for (std::size_t i = 0; i < d; ++i)
      over_segment.col(static_cast<Eigen::Index>(i)) = (vector_of(ends[first + 1 + i]) - vector_of(ends[first])) / size;
    to_end = (to_end * over_segment).eval();
    most = std::max(most, to_end.colwise().norm().maxCoeff());
  }
  return most;
}

/// The gradient of the energy, or, where nothing is conserved, every coordinate.
States displacements(const Trip& trip) {
  const State& first = trip.states.front();
  States directions;
  if (trip.system.structure().conserved.empty()) {
    for (std::size_t i = 0; i < first.size(); ++i) directions.emplace_back(first.size(), 0.0)[i] = 1.0;
  } else {
    trip.system.conserved_gradient(0, first, directions.emplace_back(first.size()));
  }
  return directions;
}

/// The most that a displacement of the first state has grown by T, where the orbit has come to `end`.
double displaced_start(const Trip& trip, const State& end) {
  double largest = unknown;
  for (const State& direction : displacements(trip)) {
    const double length = norm(direction);
    if (!(length > 0.0)) continue;
    State moved = trip.states.front();
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += displaced * trip.reach / length * direction[i];
    const State other = integrate(trip.system, moved, trip.period, trip.tolerance);
    largest = std::fmax(largest, distance(other, end) / (displaced * trip.reach));
  }
  return largest;
}

}  // namespace

OnceAround once_around(const Trip& trip, double known_growth) {
  OnceAround found;
  try {
    const State end = integrate(trip.system, trip.states.front(), trip.period, trip.tolerance);
    found.distance = distance(end, trip.states.back());
    // What is known may explain the return, or leave it open: other growth then decides nothing (verdict.cpp).
    const double known = far_return * std::fmax(1.0, known_growth);
    if (!(found.distance > known * trip.reach) || known >= nearby) return found;
    const double largest = displaced_start(trip, end);
    found.displaced_growth = largest;
    // Where this explains the return the way costs half a certificate for nothing.
    const double explained = far_return * trip.reach * (1.0 + std::fmax(largest, known_growth));
    if (found.distance > explained)
      found.displaced_growth = std::fmax(largest, growth_on_the_way(trip, displaced * trip.reach));
  } catch (const core::NumericalError&) {
  }
  return found;
}

}  // namespace orbweaver::certificate
