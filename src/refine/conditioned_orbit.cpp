#include "conditioned_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::refine {

namespace {

using Eigen::Index;
using numerics::Extended;
using numerics::WorkingDigits;

constexpr int most_iterations = 30;
/// The longest step of Newton's method in double, in the scales: nodes of a guess are nearer than that.
constexpr double longest_step = 0.3;
/// An iteration in double that moves all nodes by less, relative to their size, has arrived: rounding moves them by a
/// tenth of it, and what is left the iterations in extended arithmetic remove.
constexpr double arrived = 1e-12;
constexpr double nearly_arrived = 1e-9;
/// An orbit that is further from the guess than this part of the guess's extent is another one, or an equilibrium.
constexpr double farthest_of_extent = 0.5;
/// Of the diagonal of R: below this an iteration with the factors in double gains fewer than four digits.
constexpr double singular = 1e-11;
/// An iteration in extended arithmetic gains at least so many digits.
constexpr double least_gain = 2.0;
constexpr double cautious_gain = 10.0;  // assumed of the next ones where more has been seen
/// Digits beyond those that an iteration is to have: sums of some hundred rounded terms.
constexpr int guard = 5;

template <class Real>
Real as_real(const std::string& decimal) {
  if constexpr (std::is_same_v<Real, double>)
    return std::stod(decimal);
  else
    return numerics::extended_of(decimal);
}

template <class Real>
Real as_real(const Extended& x) {
  if constexpr (std::is_same_v<Real, double>)
    return static_cast<double>(x);
  else
    return numerics::rounded(x);
}

}  // namespace

Points<Extended> extended(const Points<double>& points) {
  Points<Extended> out;
  for (const std::vector<double>& node : points.nodes) {
    std::vector<Extended>& wide = out.nodes.emplace_back();
    for (const double x : node) wide.emplace_back(x);
  }
  out.period = Extended(points.period);
  return out;
}

Points<Extended> extended(const Points<Extended>& points) {
  Points<Extended> out;
  for (const std::vector<Extended>& node : points.nodes) {
    std::vector<Extended>& wide = out.nodes.emplace_back();
    for (const Extended& x : node) wide.push_back(numerics::rounded(x));
  }
  out.period = numerics::rounded(points.period);
  return out;
}

template <class Real>
Vector<Real> ConditionedOrbit::rows(const Shooting<Real>& shooting, const Points<Real>& points,
                                    const Passage<Real>& passage, const Held& held) const {
  Vector<Real> rows = shooting.residual(points, passage);
  if (held.kind == Held::Kind::nothing) return rows;
  rows.conservativeResize(rows.size() + 1);
  Real& row = rows(rows.size() - 1);
  switch (held.kind) {
    case Held::Kind::nothing: break;
    case Held::Kind::period: row = (points.period - as_real<Real>(held.decimal)) / _setup.scales.time; break;
    case Held::Kind::energy:
      row = (shooting.energy(points.nodes.front()) - as_real<Real>(held.decimal)) / _setup.scales.energy();
      break;
    case Held::Kind::plane: {
      row = -as_real<Real>(held.offset);
      Index n = 0;
      for (std::size_t m = 0; m < points.nodes.size(); ++m)
        for (std::size_t i = 0; i < _setup.dimension(); ++i)
          row += (points.nodes[m][i] - held.origin.nodes[m][i]) * (held.along(n++) / _setup.scales.coordinate(i));
      row += (points.period - held.origin.period) * (held.along(n) / _setup.scales.time);
      break;
    }
  }
  return rows;
}

Eigen::MatrixXd ConditionedOrbit::jacobian(const Points<double>& points, const Passage<double>& passage,
                                           const Held& held) const {
  Eigen::MatrixXd matrix = _shooting.jacobian(points, passage);
  if (held.kind == Held::Kind::nothing) return matrix;
  matrix.conservativeResize(matrix.rows() + 1, Eigen::NoChange);
  auto last = matrix.row(matrix.rows() - 1);
  last.setZero();
  switch (held.kind) {
    case Held::Kind::nothing: break;
    case Held::Kind::period: last(matrix.cols() - 1) = 1.0; break;
    case Held::Kind::energy: {
      const Eigen::VectorXd gradient = _shooting.energy_gradient(points.nodes.front());
      for (std::size_t i = 0; i < _setup.dimension(); ++i)
        last(static_cast<Index>(i)) =
            gradient(static_cast<Index>(i)) * _setup.scales.coordinate(i) / _setup.scales.energy();
      break;
    }
    case Held::Kind::plane: last = held.along.transpose(); break;
  }
  return matrix;
}

void ConditionedOrbit::require_near(const Points<double>& points, const Points<double>& guess) const {
  double extent = 0.0;
  double distance = 0.0;
  for (std::size_t m = 0; m < points.nodes.size(); ++m)
    for (std::size_t i = 0; i < _setup.dimension(); ++i) {
      const double scale = _setup.scales.coordinate(i);
      extent = std::max(extent, std::abs(guess.nodes[m][i] - guess.nodes.front()[i]) / scale);
      distance = std::max(distance, std::abs(points.nodes[m][i] - guess.nodes[m][i]) / scale);
    }
  if (distance > farthest_of_extent * extent)
    throw core::NumericalError(
        fmt::format("Newton's method came to an orbit that is {:.2g} away from the guess, whose extent is {:.2g}",
                    distance, extent));
}

Points<double> ConditionedOrbit::converge(const Points<double>& guess, const Held& held) {
  Points<double> points = guess;
  double last = std::numeric_limits<double>::infinity();
  double size = 1.0;
  for (const std::vector<double>& node : points.nodes)
    for (std::size_t i = 0; i < node.size(); ++i)
      size = std::max(size, std::abs(node[i]) / _setup.scales.coordinate(i));
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Passage<double> passage = _shooting.pass(points, true);
    const Eigen::VectorXd right = rows(_shooting, points, passage, held);
    Eigen::VectorXd step = -Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(jacobian(points, passage, held)).solve(right);
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(length)) break;
    if (length > longest_step) step *= longest_step / length;
    Index n = 0;
    for (std::vector<double>& node : points.nodes)
      for (std::size_t i = 0; i < node.size(); ++i) node[i] += step(n++) * _setup.scales.coordinate(i);
    points.period += step(n) * _setup.scales.time;
    if (!(points.period > 0.0)) break;
    if (length < arrived * size || (length < nearly_arrived * size && length > 0.5 * last)) {
      require_near(points, guess);
      return points;
    }
    last = length;
  }
  throw core::NumericalError(
      fmt::format("Newton's method found no orbit in double precision: its last step was {:.1e} of the scales", last));
}

Eigen::VectorXd ConditionedOrbit::direction(const Points<double>& points) {
  const Eigen::MatrixXd matrix = _shooting.jacobian(points, _shooting.pass(points, true));
  // The kernel is the last column of the orthogonal factor of the transpose.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(matrix.transpose());
  return factors.householderQ() * Eigen::VectorXd::Unit(matrix.cols(), matrix.cols() - 1);
}

void ConditionedOrbit::factor(const Points<double>& points, const Held& held) {
  _gain = first_gain;
  _factor.compute(jacobian(points, _shooting.pass(points, true), held));
  const Eigen::VectorXd diagonal = _factor.matrixR().diagonal().cwiseAbs();
  if (!(diagonal.minCoeff() > singular * diagonal.maxCoeff()))
    throw core::NumericalError(
        fmt::format("the orbit is not isolated: the Jacobian's least pivot is {:.1e} of the largest. {}",
                    diagonal.minCoeff() / diagonal.maxCoeff(),
                    held.kind == Held::Kind::nothing
                        ? "At a fold in the parameter its value picks no orbit; one further along the family can be had"
                        : "At an extremum of the period hold the energy, at one of the energy the period"));
}

void ConditionedOrbit::polish(Points<Extended>& points, const Held& held, double accuracy, int digits) {
  double known = accuracy;
  double gain = _gain;
  double last_length = 0.0;
  for (int iteration = 0; iteration < most_iterations + digits; ++iteration) {
    const int target = std::min(digits, static_cast<int>(std::ceil(known + 1.5 * gain)) + 3);
    const WorkingDigits working(target + guard);
    Shooting<Extended> shooting(_setup, target + guard, extra_order);
    const Vector<Extended> right = rows(shooting, points, shooting.pass(points, false), held);
    _steps += shooting.flow().steps();
    double largest = -std::numeric_limits<double>::infinity();
    for (const Extended& x : right) largest = std::max(largest, numerics::log10_abs(x));
    if (!std::isfinite(largest)) {  // no residual at all: what rounding allows at rest
      if (target == digits) return;
      known = target;
      continue;
    }
    const int exponent = static_cast<int>(std::floor(largest));
    const Extended scale = pow(Extended(10), exponent);
    Eigen::VectorXd narrow(right.size());
    for (Index n = 0; n < right.size(); ++n) narrow(n) = static_cast<double>(Extended(right(n) / scale));
    const Eigen::VectorXd step = -_factor.solve(narrow);
    Index n = 0;
    for (std::vector<Extended>& node : points.nodes)
      for (std::size_t i = 0; i < node.size(); ++i)
        numerics::add_to(node[i], Extended(scale * (step(n++) * _setup.scales.coordinate(i))));
    numerics::add_to(points.period, Extended(scale * (step(n) * _setup.scales.time)));
    const double length = -(exponent + std::log10(step.lpNorm<Eigen::Infinity>()));  // in digits
    const bool is_rounding = length > target - 1;
    if (iteration > 0 && !is_rounding) {
      gain = length - last_length;
      if (!(gain > least_gain))
        throw core::NumericalError(fmt::format(
            "iterations in extended arithmetic gain only {:.1f} digits: the orbit is too badly conditioned", gain));
      _gain = std::min(gain, cautious_gain);
    }
    if (target == digits && (is_rounding || length + gain > digits)) return;
    last_length = length;
    known = std::min(length + gain, static_cast<double>(target));
  }
  throw core::NumericalError("iterations in extended arithmetic do not converge");
}

}  // namespace orbweaver::refine
