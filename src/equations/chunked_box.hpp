#pragma once

#include <memory>

#include <Eigen/Dense>

namespace orbweaver::equations {

/// The box scheme on a fundamental domain, bordered:
///
///   y_(j+1) - y_j - (B_j / 2) (y_j + y_(j+1)) + columns_j p = r_j,   j = 0 .. cells - 1,
///   left y_0 + right y_cells = e,   sum_j rows_j y_j + corner p = b,
///
/// factored by orthogonal elimination of the inner nodes (Wright 1992: stable where solutions grow and decay), the cells
/// in as many chunks as a SIMD register has lanes, and one LU of what is left for the chunks' ends.
class ChunkedBox {
 public:
  /// Chunks, and what the number of cells must be a multiple of.
  static constexpr int lanes = 4;

  struct Matrices {
    int cells = 0;
    int stride = 0;         ///< between coordinates of nodal arrays (nodes 0 .. cells)
    const double* blocks;   ///< B_j: entry (i, l) at [(i * dimension + l) * cells + j]
    const double* columns;  ///< border p's: coordinate i of cell j at [(p * dimension + i) * stride + j]
    const double* rows;     ///< border p's, of node j at the same place
    const double* corner;   ///< borders x borders, row-major
    int borders = 0;        ///< 1 or 2
    Eigen::MatrixXd left;   ///< dimension x dimension
    Eigen::MatrixXd right;
  };

  /// For 2, 3, 4 and 6 coordinates; null for others.
  [[nodiscard]] static std::unique_ptr<ChunkedBox> of_dimension(int dimension);
  virtual ~ChunkedBox() = default;

  /// Throws NumericalError where the last system is singular or not finite.
  virtual void factor(const Matrices& m) = 0;
  /// In place: coordinate i of r_j at [i * stride + j], end condition i at [i * stride + cells], borders behind the last
  /// coordinate; on return y_j at the same places, and p.
  virtual void solve(double* x) const = 0;
};

}  // namespace orbweaver::equations
