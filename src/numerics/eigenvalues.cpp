#include "orbweaver/numerics/eigenvalues.hpp"

#include <cmath>
#include <complex>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::numerics {

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
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> complex(matrix.cast<std::complex<double>>(), with_vectors);
  if (complex.info() == Eigen::Success)
    return Eigensystem{complex.eigenvalues(), with_vectors ? complex.eigenvectors() : Eigen::MatrixXcd()};
  return std::nullopt;
}

}  // namespace orbweaver::numerics
