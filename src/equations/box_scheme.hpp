#pragma once

#include <memory>

#include <Eigen/Core>

#include "orbweaver/core/mpi/team.hpp"

namespace orbweaver::equations {

/// The box scheme of a linearised loop problem, bordered:
///
///   w (y_(j+1) - y_j) - (B_j / 2) (y_j + y_(j+1)) + columns_j p = r_j,   j = 0 .. cells - 1,
///   left y_0 + right y_cells = e,   or the loop closes: y_cells is y_0,
///   sum_j rows_j . y_j + corner p = b,
///
/// factored by orthogonal elimination (Wright 1992, doi:10.1137/0913044: stable where solutions grow and decay). The
/// cells are cut into stretches; the inner nodes of each are eliminated one by one, and one LU of what is left couples
/// the stretches' ends, the end conditions and the borders. O(cells d^3) once, O(cells d^2) a solve. Solves share
/// scratch space: one at a time.
class BoxScheme {
 public:
  /// `line`: a stretch each member of the team, for long loops and large d. `lanes`: four stretches side by side in the
  /// lanes of SIMD registers, for small d; the number of cells at hand must be a multiple of four.
  enum class Storage { line, lanes };
  static constexpr int lanes = 4;
  /// T, a parameter, and unfoldings: more than any kind of family needs.
  static constexpr int most_borders = 8;

  struct Matrices {
    int cells = 0;  ///< of the whole loop or domain
    int first = 0;  ///< `blocks` and `columns` begin with this cell,
    int count = 0;  ///< and are of so many
    int borders = 0;
    double difference = 1.0;         ///< w
    const double* blocks = nullptr;  ///< B_j: entry (i, l) at [(i * dimension + l) * count + j - first]
    const double* columns =
        nullptr;  ///< border p's: coordinate i of cell j at [(p * dimension + i) * column_stride + j - first]
    int column_stride = 0;
    const double* rows = nullptr;    ///< border q's: coordinate i of node j at [(q * dimension + i) * stride + j]
    int stride = 0;                  ///< between coordinates of nodal arrays: `rows`, and the vectors of the solves
    const double* corner = nullptr;  ///< borders x borders, row-major
    Eigen::MatrixXd left{};          ///< dimension x dimension; empty where the loop closes
    Eigen::MatrixXd right{};
  };

  [[nodiscard]] static std::unique_ptr<BoxScheme> of_dimension(int dimension, Storage storage);

  virtual ~BoxScheme() = default;
  BoxScheme() = default;
  BoxScheme(const BoxScheme&) = delete;
  BoxScheme& operator=(const BoxScheme&) = delete;
  BoxScheme(BoxScheme&&) = delete;
  BoxScheme& operator=(BoxScheme&&) = delete;

  /// `m` holds the cells of `cells_of`. With a team, this and the solves are collective over it. Throws NumericalError
  /// where what is left is singular or not finite, MisuseError for more than `most_borders`.
  virtual void factor(const Matrices& m, core::Team* team = nullptr) = 0;
  /// In place: coordinate i of r_j at [i * stride + j], e_i at [i * stride + cells], b behind the last coordinate; on
  /// return y_j at the same places, and p. Whole on every member.
  virtual void solve(double* x) const = 0;
  /// The same with the transposed matrix: the right-hand side is one of (y, p), the solution one of (r, e, b).
  virtual void solve_transposed(double* x) const = 0;
};

/// The cells that this rank eliminates: all without a team, or where the team is too large.
[[nodiscard]] core::Team::Part cells_of(const core::Team* team, int cells);

}  // namespace orbweaver::equations
