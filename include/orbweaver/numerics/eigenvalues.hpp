#pragma once

#include <optional>

#include <Eigen/Core>

namespace orbweaver::numerics {

struct Eigensystem {
  Eigen::VectorXcd values;   ///< n, in no order
  Eigen::MatrixXcd vectors;  ///< n x n, one a column, of length 1; empty where they were not asked for
};

/// An orthogonal n x n matrix in general position, always the same for one n.
[[nodiscard]] Eigen::MatrixXd orthogonal_in_general_position(Eigen::Index n);

/// Eigenvalues of a square matrix by Eigen's QR iteration; where that does not end, as beside double eigenvalues that
/// rounding has split (its shifts then go around in a circle), by the one for complex matrices, whose values are
/// made exact conjugates. Nothing where neither ends, or the matrix is not finite.
[[nodiscard]] std::optional<Eigensystem> eigensystem(const Eigen::MatrixXd& matrix, bool with_vectors);

}  // namespace orbweaver::numerics
