#include "curve_equations.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int newton_steps = 12;

}  // namespace

CurveEquations::CurveEquations(const systems::System& system, const EquilibriumCurveOptions& options)
    : _system(system),
      _name(system.family_scalars().free.front()),
      _unit(system.parameter_scale(_name)),
      _options(options),
      _d(system.dimension()) {}

CurveEquations::Linear CurveEquations::at(const VectorXd& x) const {
  const std::shared_ptr<const systems::System> here = _system.with_parameters({{_name, x(_d) * _unit}});
  Linear out{VectorXd(_d), MatrixXd(), VectorXd(_d)};
  RowMajor jacobian(_d, _d);
  here->field_jacobian(1, x.data(), out.f.data(), jacobian.data());
  here->parameter_derivatives(_name, 1, x.data(), out.by_parameter.data());
  out.jacobian = jacobian;
  return out;
}

std::optional<VectorXd> CurveEquations::corrected(VectorXd guess, const VectorXd& row, int& steps, double to) const {
  VectorXd x = guess;
  for (steps = 0; steps < newton_steps; ++steps) {
    const Linear linear = at(x);
    if (!linear.f.allFinite() || !linear.jacobian.allFinite()) return std::nullopt;
    MatrixXd matrix(_d + 1, _d + 1);
    matrix << linear.jacobian, linear.by_parameter, row.transpose();
    VectorXd right(_d + 1);
    right << -linear.f, row.dot(guess - x);
    const VectorXd step = Eigen::PartialPivLU<MatrixXd>(matrix).solve(right);
    if (!step.allFinite()) return std::nullopt;
    x += step;
    if (step.norm() <= to * (1.0 + x.norm())) return x;
  }
  return std::nullopt;
}

VectorXd CurveEquations::direction(const VectorXd& x, const VectorXd& near) const {
  const Linear linear = at(x);
  MatrixXd matrix(_d + 1, _d + 1);
  matrix << linear.jacobian, linear.by_parameter, near.transpose();
  const VectorXd out = Eigen::PartialPivLU<MatrixXd>(matrix).solve(VectorXd::Unit(_d + 1, _d));
  return out.allFinite() ? VectorXd(out.normalized()) : near;
}

MatrixXd CurveEquations::bordered(const VectorXd& x, const VectorXd& near) const {
  const Linear linear = at(x);
  MatrixXd matrix(_d + 1, _d + 1);
  matrix << linear.jacobian, linear.by_parameter, direction(x, near).transpose();
  return matrix;
}

GradedSpectrum CurveEquations::eigensystem(const VectorXd& x, bool with_vectors) const {
  std::optional<GradedSpectrum> system = graded_spectrum(at(x).jacobian, with_vectors);
  if (!system)
    throw core::NumericalError(
        fmt::format("the eigenvalues of the Jacobian at the equilibrium at {} = {:.9g}: the QR "
                    "iteration does not converge",
                    _name, x(_d)));
  return std::move(*system);
}

VectorXd cubic_between(const CurveNode& a, const CurveNode& b, double share) {
  const VectorXd chord = b.x - a.x;
  const double rest = 1.0 - share;
  const double length = chord.norm();
  return a.x + share * share * (3.0 - 2.0 * share) * chord +
         length * share * rest * (rest * a.direction - share * b.direction);
}

}  // namespace orbweaver::starts
