#include "orbweaver/numerics/eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::numerics {

namespace {

using Complex = std::complex<double>;

/// Eigenvalues of a real matrix that rounding has left no exact conjugates: each with the nearest to its conjugate.
void make_conjugate(Eigen::VectorXcd& values) {
  std::vector<Eigen::Index> left(static_cast<std::size_t>(values.size()));
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    Complex& value = values(left.front());
    const auto partner = std::min_element(left.begin(), left.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::abs(values(a) - std::conj(value)) < std::abs(values(b) - std::conj(value));
    });
    value = 0.5 * (value + std::conj(values(*partner)));
    values(*partner) = std::conj(value);
    left.erase(partner);
    if (!left.empty() && &values(left.front()) == &value) left.erase(left.begin());
  }
}

}  // namespace

Eigen::MatrixXd orthogonal_in_general_position(Eigen::Index n) {
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      matrix(i, j) = std::cos(1.0 + 2.0 * static_cast<double>(i * n + j) + 0.7 * static_cast<double>(j * j));
  return Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).householderQ();
}

std::optional<Eigensystem> eigensystem(const Eigen::MatrixXd& matrix, bool with_vectors) {
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> real(matrix, with_vectors);
  if (real.info() == Eigen::Success)
    return Eigensystem{real.eigenvalues(), with_vectors ? real.eigenvectors() : Eigen::MatrixXcd()};
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> complex(Eigen::MatrixXcd(matrix.cast<Complex>()), with_vectors);
  if (complex.info() != Eigen::Success) return std::nullopt;
  Eigensystem system{complex.eigenvalues(), with_vectors ? complex.eigenvectors() : Eigen::MatrixXcd()};
  make_conjugate(system.values);
  return system;
}

}  // namespace orbweaver::numerics
