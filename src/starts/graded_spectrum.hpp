#pragma once

#include <optional>

#include <Eigen/Core>

namespace orbweaver::starts {

/// Eigenvalues of a matrix, each with what rounding is relative to: relative changes of size e of the matrix's entries
/// move it by e times its size, |w|^T |A| |v| / |w . v| with its left and right vectors, to first order. Where all are
/// of one order that is about the largest; beside a fast eigenvalue a slow one has a size of its own.
struct GradedSpectrum {
  Eigen::VectorXcd values;   ///< n, in no order
  Eigen::VectorXd sizes;     ///< one an eigenvalue, the largest modulus at most
  Eigen::MatrixXcd vectors;  ///< n x n, one a column, of length 1; empty where they were not asked for
};

/// In double precision, with the largest modulus for all sizes, where the QR iteration's rounding, which is relative to
/// that, is small beside every eigenvalue; in quadruple precision elsewhere. Nothing where the iteration does not end.
[[nodiscard]] std::optional<GradedSpectrum> graded_spectrum(const Eigen::MatrixXd& matrix, bool with_vectors);

}  // namespace orbweaver::starts
