#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "graded_spectrum.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "orbweaver/starts/equilibrium_curve.hpp"

namespace orbweaver::starts {

/// A Newton step below this, in parts of 1 + |z|, is rounding's.
inline constexpr double converged = 1e-13;
/// Zeros are located to this, in parts of a step.
inline constexpr double located_to = 1e-12;
/// Of what an eigenvalue's rounding is relative to: a real part, or an eigenvalue, that may be rounding's.
inline constexpr double at_end = 1e-12;
/// A branch point is located to this, relative, and then by a parabola. There rounding is 1e5 times as large across the
/// curve.
inline constexpr double near_singular = 1e-5;
inline constexpr double converged_beside = 1e-8;
/// What these two are relative to: the error of places beside a singular one is the root of their rounding.
[[nodiscard]] inline double known_to(const Eigen::VectorXd& x) { return std::sqrt(1.0 + x.norm()); }
[[nodiscard]] inline double beside_singular(const Eigen::VectorXd& x) { return near_singular * known_to(x); }

/// A place on the curve: the state, then the parameter.
struct CurveNode {
  Eigen::VectorXd x;
  Eigen::VectorXd direction;
};

/// What holds at the places of a curve of equilibria in a parameter: the equation, its directions and eigenvalues.
class CurveEquations {
 public:
  CurveEquations(const systems::System& system, const EquilibriumCurveOptions& options);

  /// On the hyperplane through `guess` across `row`.
  [[nodiscard]] std::optional<Eigen::VectorXd> corrected(Eigen::VectorXd guess, const Eigen::VectorXd& row, int& steps,
                                                         double to = converged) const;
  /// The unit null vector of (J, df/dp), on the side of `near`.
  [[nodiscard]] Eigen::VectorXd direction(const Eigen::VectorXd& x, const Eigen::VectorXd& near) const;
  /// Derivatives of the equation by state and parameter, then the curve's direction.
  [[nodiscard]] Eigen::MatrixXd bordered(const Eigen::VectorXd& x, const Eigen::VectorXd& near) const;

  [[nodiscard]] Eigen::VectorXcd eigenvalues(const Eigen::VectorXd& x) const { return eigensystem(x, false).values; }
  /// Throws NumericalError where the QR iteration does not converge.
  [[nodiscard]] GradedSpectrum eigensystem(const Eigen::VectorXd& x, bool with_vectors) const;

  [[nodiscard]] Equilibrium equilibrium(const Eigen::VectorXd& x) const { return {{x.data(), x.data() + _d}, x(_d)}; }
  [[nodiscard]] bool is_within(double parameter) const {
    return parameter >= _options.parameter_from && parameter <= _options.parameter_to;
  }
  [[nodiscard]] const EquilibriumCurveOptions& options() const { return _options; }
  [[nodiscard]] const systems::System& system() const { return _system; }
  [[nodiscard]] Eigen::Index dimension() const { return _d; }
  [[nodiscard]] const std::string& name() const { return _name; }
  [[nodiscard]] double unit() const { return _unit; }

 private:
  struct Linear {
    Eigen::VectorXd f;
    Eigen::MatrixXd jacobian;  // d x d
    Eigen::VectorXd by_parameter;
  };
  [[nodiscard]] Linear at(const Eigen::VectorXd& x) const;

  const systems::System& _system;
  const std::string& _name;
  double _unit;
  const EquilibriumCurveOptions& _options;
  Eigen::Index _d;
};

/// Between two nodes, by the cubic through both with their directions.
[[nodiscard]] Eigen::VectorXd cubic_between(const CurveNode& a, const CurveNode& b, double share);

/// The zero of a function of places between two nodes: the corrected place on the chord, share of the way.
template <class F>
std::optional<Eigen::VectorXd> zero_between(const CurveEquations& curve, const CurveNode& a, const CurveNode& b,
                                            const F& function) {
  const Eigen::VectorXd chord = b.x - a.x;
  std::optional<Eigen::VectorXd> place;
  const auto there = [&](double share) {
    int steps = 0;
    place = curve.corrected(a.x + share * chord, chord.normalized(), steps);
    return place ? function(*place) : std::numeric_limits<double>::quiet_NaN();
  };
  const auto found = numerics::locate_root(there, 0.0, 1.0, located_to);
  if (!found) return std::nullopt;
  static_cast<void>(there(found->position));
  return place;
}

/// The same beside another curve, which passes through the zero: by halves, each from the cubic through the places and
/// directions of its ends, which comes nearer to this curve than the other one is; the last of them by the values at
/// its ends and at the end before.
template <class F>
std::optional<Eigen::VectorXd> zero_beside_curve(const CurveEquations& curve, CurveNode a, CurveNode b,
                                                 const F& function) {
  struct Value {
    double share;
    double value;
  };
  Value at_a{0.0, function(a.x)};
  Value at_b{1.0, function(b.x)};
  Value beyond = at_b;
  if (!(at_a.value * at_b.value < 0.0)) return std::nullopt;
  do {
    int steps = 0;
    const auto x =
        curve.corrected(cubic_between(a, b, 0.5), (b.x - a.x).normalized(), steps, converged_beside / known_to(a.x));
    if (!x) return std::nullopt;
    CurveNode middle{*x, curve.direction(*x, a.direction)};
    const Value there{0.5 * (at_a.share + at_b.share), function(*x)};
    if (!(std::abs(there.value) > 0.0)) return x;
    const bool is_before = there.value * at_a.value < 0.0;
    beyond = std::exchange(is_before ? at_b : at_a, there);
    (is_before ? b : a) = std::move(middle);
  } while ((b.x - a.x).norm() > beside_singular(a.x));
  // The share as a quadratic function of the value, at 0.
  const auto weight = [](double own, double x, double y) { return x * y / ((x - own) * (y - own)); };
  const double share = at_a.share * weight(at_a.value, at_b.value, beyond.value) +
                       at_b.share * weight(at_b.value, at_a.value, beyond.value) +
                       beyond.share * weight(beyond.value, at_a.value, at_b.value);
  const double within = (share - at_a.share) / (at_b.share - at_a.share);
  return cubic_between(a, b, std::clamp(within, 0.0, 1.0));
}

}  // namespace orbweaver::starts
