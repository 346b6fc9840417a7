#include "fitted_cells.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::equations {

namespace {

/// Of |B_j / 2 w|, half the angle by which the flow turns over a cell. From the first on, tan x is off by 3 % from the
/// plain scheme's x; beyond the second, near half a turn a cell, the oscillation is not resolved, and the fit would put
/// it at a frequency that it does not have.
constexpr double plain = 0.3;
constexpr double resolved = 1.4;

template <int D>
bool fit(double* blocks, Eigen::Index dimension, Eigen::Index count, double difference) {
  using Matrix = Eigen::Matrix<double, D, D>;
  const Matrix unit = Matrix::Identity(dimension, dimension);
  Matrix x(dimension, dimension);
  bool any = false;
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < dimension; ++i)
      for (Eigen::Index l = 0; l < dimension; ++l)
        x(i, l) = blocks[(i * dimension + l) * count + j] / (2.0 * difference);
    const Matrix square = x * x;
    const double size = std::pow((square * square).squaredNorm(), 0.125);  // |X^4|^(1/4): no matter of units
    if (!(size > plain && size < resolved)) continue;
    // tanh, to 1 % up to x = 1.4i.
    const Matrix fitted = (15.0 * unit + 6.0 * square).partialPivLu().solve(x * (15.0 * unit + square));
    for (Eigen::Index i = 0; i < dimension; ++i)
      for (Eigen::Index l = 0; l < dimension; ++l)
        blocks[(i * dimension + l) * count + j] = 2.0 * difference * fitted(i, l);
    any = true;
  }
  return any;
}

}  // namespace

std::vector<double> fitted_cells(const double* blocks, int dimension, int count, double difference) {
  std::vector<double> out(blocks, blocks + static_cast<std::ptrdiff_t>(dimension) * dimension * count);
  const bool any = dimension == 4 ? fit<4>(out.data(), dimension, count, difference)
                                  : fit<Eigen::Dynamic>(out.data(), dimension, count, difference);
  if (!any) out.clear();
  return out;
}

}  // namespace orbweaver::equations
