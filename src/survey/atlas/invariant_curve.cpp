#include "orbweaver/survey/atlas/invariant_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::survey {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array<Invariant, 3> variables{Invariant::period, Invariant::level, Invariant::energy};
/// Nodes on either side of a segment: degree five is the highest that noise of 1e-10 does not spoil at uneven
/// distances.
constexpr std::size_t widest = 3;
constexpr std::size_t nearby = 4;          // segments on either side of the last place
constexpr std::size_t most_failures = 64;  // searches of a whole curve: more orbits off it tell nothing new
/// Both orbits have errors, and that of the variable moves the place by as much again.
constexpr double errors_of_both = 3.0;
/// Of the difference between two polynomials, where neighbours are far apart.
constexpr double safety = 3.0;
/// Of the change between two neighbours: what a straight line between them may be off where nothing says more.
constexpr double straight = 0.5;

struct Window {
  std::size_t first;
  std::size_t count;
};

// `count` nodes around the segment, moved inwards at the ends of the curve.
Window window_around(std::size_t segment, std::size_t count, std::size_t points) {
  count = std::min(count, points);
  const std::size_t before = count / 2 - 1;
  const std::size_t first = segment > before ? segment - before : 0;
  return {std::min(first, points - count), count};
}

/// `of`: what is interpolated, as a function of the invariant.
template <class Of>
double interpolated(const std::vector<Invariants>& points, const Window& window, Invariant variable, Invariant value,
                    double at, const Of& of) {
  std::vector<double> nodes;
  for (std::size_t n = 0; n < window.count; ++n) nodes.push_back(points[window.first + n].value(variable));
  const std::vector<double> weights = numerics::lagrange_weights(nodes, at).value;
  double sum = 0.0;
  for (std::size_t n = 0; n < window.count; ++n) sum += weights[n] * of(points[window.first + n].value(value));
  return sum;
}

double interpolated(const std::vector<Invariants>& points, const Window& window, Invariant variable, Invariant value,
                    double at) {
  return interpolated(points, window, variable, value, at, [](double x) { return x; });
}

bool is_monotone(const std::vector<Invariants>& points, const Window& window, Invariant variable) {
  const double whole = points[window.first + window.count - 1].value(variable) - points[window.first].value(variable);
  for (std::size_t i = window.first; i + 1 < window.first + window.count; ++i)
    if (!((points[i + 1].value(variable) - points[i].value(variable)) * whole > 0.0)) return false;
  return true;
}

// The variable that tells best where between the two nodes an orbit lies.
std::optional<Invariant> best_variable(const std::vector<Invariants>& points, const Window& window,
                                       std::size_t segment) {
  std::optional<Invariant> best;
  double most = 0.0;
  for (const Invariant variable : variables) {
    if (!is_monotone(points, window, variable)) continue;
    const double change = std::abs(points[segment + 1].value(variable) - points[segment].value(variable)) /
                          points[segment].floor_of(variable);
    if (change > most) {
      most = change;
      best = variable;
    }
  }
  return best;
}

// Single differences vanish here and there; all of them do not.
double error_of(const std::vector<Invariants>& points, const Window& window, std::size_t segment, Invariant variable,
                Invariant value, double at, double best) {
  double error = 0.0;
  for (const Window& smaller : {window_around(segment, window.count - 2, points.size()),
                                Window{window.first, window.count - 1}, Window{window.first + 1, window.count - 1}})
    error = std::fmax(error, std::abs(best - interpolated(points, smaller, variable, value, at)));
  return safety * error;
}

/// What the interpolated trace is off by that of the stability values themselves: where these are large and change
/// their sign between two orbits, neither is known.
double error_of_trace(const std::vector<Invariants>& points, const Window& window, Invariant variable, double at,
                      double trace) {
  const double values =
      interpolated(points, window, variable, Invariant::trace, at, [](double x) { return std::sinh(x); });
  return std::abs(std::asinh(values) - trace);
}

// A parabola's, that leaves the straight line by `straight` of the change.
double error_of_chord(const Invariants& a, const Invariants& b, Invariant variable, Invariant value, double at) {
  const double u = (at - a.value(variable)) / (b.value(variable) - a.value(variable));
  return 4.0 * straight * std::abs(u * (1.0 - u) * (b.value(value) - a.value(value)));
}

bool is_between(double from, double to, double value, double margin) {
  return value >= std::min(from, to) - margin && value <= std::max(from, to) + margin;
}

void add_deviation(CurveFit& fit, Invariant invariant, double deviation, double error, const Invariants& x) {
  if (std::isnan(deviation)) return;
  const double allowed = errors_of_both * x.floor_of(invariant) + error;
  const double excess = deviation / allowed;
  if (!(excess >= fit.excess)) return;
  fit.excess = excess;
  fit.worst = invariant;
  fit.deviation = deviation / x.scale_of(invariant);
  fit.allowed = allowed / x.scale_of(invariant);
}

CurveFit better(const CurveFit& a, const CurveFit& b) { return b.excess < a.excess ? b : a; }

CurveFit nowhere() {
  CurveFit fit;
  fit.excess = infinity;
  return fit;
}

}  // namespace

CurveFit InvariantCurve::fit_beside(const Invariants& x, std::size_t segment) const {
  for (std::size_t reach = widest; reach >= 1; --reach) {
    const Window window = window_around(segment, 2 * reach, _points.size());
    const std::optional<Invariant> variable = best_variable(_points, window, segment);
    if (!variable) continue;
    const Invariants& a = _points[segment];
    const Invariants& b = _points[segment + 1];
    const double at = x.value(*variable);
    if (!is_between(a.value(*variable), b.value(*variable), at, errors_of_both * x.floor_of(*variable)))
      return nowhere();
    CurveFit fit;
    fit.segment = segment;
    fit.measured = true;
    for (const Invariant invariant : all_invariants) {
      if (invariant == *variable) continue;
      const double value = interpolated(_points, window, *variable, invariant, at);
      double error = window.count > 2 ? error_of(_points, window, segment, *variable, invariant, at, value)
                                      : error_of_chord(a, b, *variable, invariant, at);
      if (invariant == Invariant::trace)
        error = std::fmax(error, error_of_trace(_points, window, *variable, at, value));
      if (!std::isnan(error)) fit.measured = fit.measured && error <= x.floor_of(invariant);
      add_deviation(fit, invariant, std::abs(value - x.value(invariant)), error, x);
    }
    return fit;
  }
  return nowhere();
}

CurveFit InvariantCurve::fit_at_point(const Invariants& x) const {
  CurveFit fit;
  fit.measured = true;
  for (const Invariant invariant : all_invariants)
    add_deviation(fit, invariant, std::abs(_points.front().value(invariant) - x.value(invariant)), 0.0, x);
  return fit;
}

CurveFit InvariantCurve::fit_near(const Invariants& x, std::size_t hint, std::size_t distance) const {
  if (_points.empty()) return nowhere();
  if (_points.size() == 1) return fit_at_point(x);
  const std::size_t last = std::min(hint + distance, _points.size() - 2);
  CurveFit best = nowhere();
  for (std::size_t segment = hint > distance ? hint - distance : 0; segment <= last; ++segment)
    best = better(best, fit_beside(x, segment));
  return best;
}

CurveFit InvariantCurve::fit_anywhere(const Invariants& x) const {
  if (_points.empty()) return nowhere();
  if (_points.size() == 1) return fit_at_point(x);
  CurveFit best = nowhere();
  for (std::size_t segment = 0; segment + 1 < _points.size(); ++segment) {
    const bool may = std::any_of(variables.begin(), variables.end(), [&](Invariant v) {
      return is_between(_points[segment].value(v), _points[segment + 1].value(v), x.value(v),
                        errors_of_both * x.floor_of(v));
    });
    if (may) best = better(best, fit_beside(x, segment));
  }
  return best;
}

std::vector<CurveFit> fit_all(const InvariantCurve& curve, const std::vector<Invariants>& orbits) {
  std::vector<CurveFit> fits;
  fits.reserve(orbits.size());
  std::size_t hint = 0;
  std::size_t failures = 0;
  for (const Invariants& x : orbits) {
    CurveFit fit = curve.fit_near(x, hint, nearby);
    const bool search = failures < most_failures;
    for (std::size_t distance = 4 * nearby; search && !fit.fits() && distance < 4 * curve.points().size();
         distance *= 4)
      fit = better(fit, curve.fit_near(x, hint, distance));
    if (search && !fit.fits()) ++failures;
    if (fit.fits()) hint = fit.segment;
    fits.push_back(fit);
  }
  return fits;
}

const char* name_of(Invariant invariant) {
  switch (invariant) {
    case Invariant::period: return "period";
    case Invariant::level: return "energy or parameter";
    case Invariant::action: return "action";
    case Invariant::energy: return "energy";
    case Invariant::trace: return "stability";
  }
  return "unknown";
}

}  // namespace orbweaver::survey
