#include "floquet_indices.hpp"

#include <cmath>
#include <limits>

#include "matrix_table.hpp"
#include "product_eigenvalues.hpp"

namespace orbweaver::spectrum {

namespace {

using Complex = std::complex<double>;

/// Of the product of matrices of symmetries: exact up to roundings, or of order 1 away.
constexpr double same_matrix = 1e-6;

/// +1 or -1 if `around` is that multiple of the unit matrix, else 0.
int sign_of(const Eigen::MatrixXd& around) {
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(around.rows(), around.cols());
  if ((around - unit).norm() < same_matrix) return 1;
  if ((around + unit).norm() < same_matrix) return -1;
  return 0;
}

/// mu^p + mu^-p from k = mu + 1/mu: the Chebyshev recurrence.
Complex repeated_index(Complex k, int order) {
  Complex before = 2.0;
  Complex now = k;
  for (int n = 1; n < order; ++n) {
    const Complex next = k * now - before;
    before = now;
    now = next;
  }
  return now;
}

Complex power(Complex mu, int order) {
  Complex result = 1.0;
  for (int n = 0; n < order; ++n) result *= mu;
  return result;
}

Eigen::Matrix2d product_of_factors(const TransverseFlow& flow) {
  Eigen::Matrix2d product = matrix_in<2>(flow.factors, 0, 2);
  for (Eigen::Index m = 1; m < flow.factors.cols(); ++m) product = (matrix_in<2>(flow.factors, m, 2) * product).eval();
  return product;
}

std::vector<Eigen::MatrixXd> factors_of(const TransverseFlow& flow, int repeated) {
  std::vector<Eigen::MatrixXd> factors;
  for (int n = 0; n < repeated; ++n)
    for (Eigen::Index m = 0; m < flow.factors.cols(); ++m)
      factors.emplace_back(matrix_in<Eigen::Dynamic>(flow.factors, m, flow.dimension()));
  return factors;
}

}  // namespace

bool is_single_pair(const systems::Structure& system, const TransverseFlow& flow) {
  return system.symplectic && flow.dimension() == 2 && sign_of(flow.around) != 0;
}

FloquetIndices floquet_indices(const systems::Structure& system, const TransverseFlow& flow, int order) {
  FloquetIndices result;
  if (system.symplectic && flow.dimension() == 2) {
    const Eigen::Matrix2d map = product_of_factors(flow);
    result.fundamental = {map.trace()};
    if (flow.orientation != 0.0) result.twist = 0.5 * flow.orientation * (map(1, 0) - map(0, 1));
  } else
    result.fundamental = product_eigenvalues(factors_of(flow, 1), system.symplectic);
  const int sign = sign_of(flow.around);
  if (sign == 0) {
    std::vector<Eigen::MatrixXd> factors = factors_of(flow, order);
    factors.push_back(flow.around);
    result.full = product_eigenvalues(factors, system.symplectic);
    return result;
  }
  for (const Complex& value : result.fundamental)
    result.full.push_back(static_cast<double>(sign) *
                          (system.symplectic ? repeated_index(value, order) : power(value, order)));
  return result;
}

double repeated_index_error(double k, double error, int order) {
  // Values and first two derivatives of the recurrence with all signs positive bound those of the Chebyshev polynomial.
  struct Bound {
    double value;
    double slope;
    double curvature;
  };
  const double size = std::abs(k);
  Bound before{2.0, 0.0, 0.0};
  Bound now{size, 1.0, 0.0};
  for (int n = 1; n < order; ++n) {
    const Bound next{size * now.value + before.value, now.value + size * now.slope + before.slope,
                     2.0 * now.slope + size * now.curvature + before.curvature};
    before = now;
    now = next;
  }
  return now.slope * error + 0.5 * now.curvature * error * error +
         2.0 * std::numeric_limits<double>::epsilon() * order * now.value;
}

}  // namespace orbweaver::spectrum
