#include "hermite_rule.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace orbweaver::spectrum {

namespace {

using Long = long double;

/// Fornberg's weights: [j][n] of the value at node n in the derivative j at 0.
std::vector<std::vector<Long>> derivative_weights(const std::vector<Long>& x, std::size_t highest) {
  std::vector<std::vector<Long>> c(highest + 1, std::vector<Long>(x.size(), 0.0L));
  Long c1 = 1.0L;
  Long c4 = x[0];
  c[0][0] = 1.0L;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const std::size_t most = i < highest ? i : highest;
    Long c2 = 1.0L;
    const Long c5 = c4;
    c4 = x[i];
    for (std::size_t j = 0; j < i; ++j) {
      const Long c3 = x[i] - x[j];
      c2 *= c3;
      if (j == i - 1) {
        for (std::size_t k = most; k > 0; --k)
          c[k][i] = c1 * (static_cast<Long>(k) * c[k - 1][i - 1] - c5 * c[k][i - 1]) / c2;
        c[0][i] = -c1 * c5 * c[0][i - 1] / c2;
      }
      for (std::size_t k = most; k > 0; --k) c[k][j] = (c4 * c[k][j] - static_cast<Long>(k) * c[k - 1][j]) / c3;
      c[0][j] = c4 * c[0][j] / c3;
    }
    c1 = c2;
  }
  return c;
}

}  // namespace

HermiteRule::HermiteRule() {
  std::vector<Long> points;
  for (std::size_t n = 0; n <= 2 * reach; ++n)
    points.push_back((static_cast<Long>(n) - static_cast<Long>(reach)) / static_cast<Long>(parts));
  const std::vector<std::vector<Long>> weights = derivative_weights(points, terms - 1);
  for (std::size_t level = 0; level < levels; ++level) {
    const std::size_t n = terms - level;
    Long value = 1.0L;  // n! (2n - k)! / ((2n)! (n - k)!)
    for (std::size_t k = 0; k <= terms; ++k) {
      ends[level][k] = k <= n ? static_cast<double>(value) : 0.0;
      if (k < n) value *= static_cast<Long>(n - k) / static_cast<Long>(2 * n - k);
    }
  }
  Long even_size = 0.0L;
  Long odd_size = 0.0L;
  Long factorial = 1.0L;
  for (std::size_t j = 0; j < terms; ++j) {
    if (j > 0) factorial *= static_cast<Long>(j);
    for (std::size_t k = 0; k <= reach; ++k)
      stencil[j][k] = static_cast<double>(weights[j][reach + k] / factorial);
    // In the integral of A, coefficient j counts beta_(j+1) j!.
    const Long counted = static_cast<Long>(ends[0][j + 1].packed[0]) / static_cast<Long>(j + 1);
    (j % 2 == 0 ? even_size : odd_size) += std::abs(weights[j][2 * reach] / factorial) * counted;
  }
  Long binomial = 1.0L;  // of 2 reach over reach + k, with alternating sign
  for (std::size_t k = reach + 1; k-- > 0;) {
    even_change[k] = static_cast<double>(even_size * binomial);
    odd_change[k] = static_cast<double>(odd_size * binomial * static_cast<Long>(k) / static_cast<Long>(reach));
    binomial *= -static_cast<Long>(reach + k) / static_cast<Long>(reach - k + 1);
  }
  // The sum's part of a wave of x radians a point is (x/2) / tan(x/2).
  constexpr int waves = 400;
  Eigen::MatrixXd sines(waves, static_cast<Eigen::Index>(fast_reach));
  Eigen::VectorXd missing(waves);
  for (int n = 0; n < waves; ++n) {
    const double x = fastest * (n + 0.5) / waves;
    for (Eigen::Index k = 0; k < sines.cols(); ++k) sines(n, k) = x * std::sin(static_cast<double>(k + 1) * x);
    missing[n] = 1.0 - 0.5 * x / std::tan(0.5 * x);
  }
  const Eigen::VectorXd shares = sines.householderQr().solve(missing);
  for (std::size_t k = 0; k < fast_reach; ++k) fast[k] = -0.5 * shares[static_cast<Eigen::Index>(k)];
}

const HermiteRule& hermite_rule() {
  static const HermiteRule rule;
  return rule;
}

}  // namespace orbweaver::spectrum
