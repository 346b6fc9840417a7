#include "branch_points.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

/// A determinant of rows of at most length 1 that is smaller is rounding's.
constexpr double dependent = 1e-13;

/// The real eigenvalue of least modulus; NaN without one.
double least_real_eigenvalue(const CurveEquations& curve, const VectorXd& x) {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const Complex value : curve.eigenvalues(x))
    if (value.imag() == 0.0 && !(std::abs(value.real()) >= std::abs(least))) least = value.real();
  return least;
}

int positive_real(const Eigen::VectorXcd& values) {
  return static_cast<int>(std::count_if(
      values.begin(), values.end(), [](const Complex& value) { return value.imag() == 0.0 && value.real() > 0.0; }));
}

/// Where that determinant passes zero between two nodes.
std::optional<VectorXd> branch_point_between(const CurveEquations& curve, const CurveNode& a, const CurveNode& b) {
  const VectorXd lengths =
      curve.bordered(a.x, a.direction).rowwise().norm().cwiseMax(curve.bordered(b.x, a.direction).rowwise().norm());
  return zero_beside_curve(curve, a, b, [&](const VectorXd& at) {
    const MatrixXd scaled = lengths.cwiseInverse().asDiagonal() * curve.bordered(at, a.direction);
    return Eigen::PartialPivLU<MatrixXd>(scaled).determinant();
  });
}

/// Where an even number of real eigenvalues pass zero together, and the determinant keeps its sign.
std::optional<VectorXd> double_branch_point_between(const CurveEquations& curve, const CurveNode& a,
                                                    const CurveNode& b) {
  const int change = positive_real(curve.eigenvalues(b.x)) - positive_real(curve.eigenvalues(a.x));
  if (change == 0 || change % 2 != 0) return std::nullopt;
  const auto least = [&](const VectorXd& at) { return least_real_eigenvalue(curve, at); };
  const auto vanishes = [&](const VectorXd& at) {
    return std::abs(least(at)) <= at_end * curve.eigenvalues(at).cwiseAbs().maxCoeff();
  };
  if (vanishes(a.x) != vanishes(b.x)) return vanishes(a.x) ? a.x : b.x;  // at both it may be zero all along
  if (!(least(a.x) * least(b.x) < 0.0)) return std::nullopt;  // two have met and left the axis, or come to it
  return zero_beside_curve(curve, a, b, least);
}

}  // namespace

int sign_of_determinant(const CurveEquations& curve, const CurveNode& node) {
  const MatrixXd matrix = curve.bordered(node.x, node.direction);
  const double value =
      Eigen::PartialPivLU<MatrixXd>(matrix.rowwise().norm().cwiseInverse().asDiagonal() * matrix).determinant();
  return std::abs(value) > dependent ? (value > 0.0 ? 1 : -1) : 0;
}

std::optional<VectorXd> branch_point_before(const CurveEquations& curve, const std::vector<CurveNode>& nodes,
                                            const std::vector<int>& signs, std::size_t n, bool folds) {
  if (signs[n - 1] * signs[n] < 0) return branch_point_between(curve, nodes[n - 1], nodes[n]);
  if (signs[n] == 0 && n + 1 < nodes.size() && signs[n - 1] * signs[n + 1] < 0) return nodes[n].x;
  return folds ? std::nullopt : double_branch_point_between(curve, nodes[n - 1], nodes[n]);
}

}  // namespace orbweaver::starts
