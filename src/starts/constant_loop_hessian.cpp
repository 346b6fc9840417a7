#include "constant_loop_hessian.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::starts {

namespace {

/// A bound from another value, less rounding of both, which must not leave out the smaller of two that are equal.
constexpr double room = 1.0 - 1e-12;

}  // namespace

ConstantLoopHessian::ConstantLoopHessian(const Eigen::MatrixXd& jacobian, int cutoff, Harmonics harmonics)
    : _a(jacobian), _every(harmonics == Harmonics::odd ? 2 : 1) {
  core::require(cutoff >= 1, "a Hessian needs a harmonic");
  if (!std::isfinite(jacobian.squaredNorm()))
    throw core::NotFiniteError("the Hessian of the constant loop at a fixed point is not finite");
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(_a).singularValues();
  _mean = harmonics == Harmonics::odd ? std::numeric_limits<double>::infinity() : values(values.size() - 1);
  _largest = values(0);
  _known.assign(static_cast<std::size_t>((cutoff + _every - 1) / _every), {0.0, 0.0});
}

ConstantLoopHessian::Smallest ConstantLoopHessian::smallest(double period) {
  Smallest out{2.0 * _mean * _mean, 0};
  for (std::size_t n = 0; n < _known.size(); ++n) {
    const int k = 1 + _every * static_cast<int>(n);
    const double rate = 2.0 * std::numbers::pi * k / period;
    // No singular value moves faster than the rate, and none is further from it than A is large.
    const double moved = _known[n].singular_value - std::abs(rate - _known[n].rate);
    const double bound = room * std::max(moved, rate - _largest);
    if (bound > 0.0 && bound * bound > out.eigenvalue) continue;
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXcd>(block(rate)).singularValues();
    _known[n] = {rate, values(values.size() - 1)};
    const double square = _known[n].singular_value * _known[n].singular_value;
    if (square < out.eigenvalue) out = {square, k};
  }
  return out;
}

Eigen::VectorXcd ConstantLoopHessian::first_harmonic(double period) const {
  return Eigen::JacobiSVD<Eigen::MatrixXcd>(block(2.0 * std::numbers::pi / period),
                                            Eigen::ComputeFullU | Eigen::ComputeFullV)
      .matrixV()
      .rightCols(1);
}

Eigen::MatrixXcd ConstantLoopHessian::block(double rate) const {
  return std::complex<double>(0.0, rate) * Eigen::MatrixXcd::Identity(_a.rows(), _a.cols()) -
         _a.cast<std::complex<double>>();
}

}  // namespace orbweaver::starts
