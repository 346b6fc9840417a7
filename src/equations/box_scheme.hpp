#pragma once

#include <memory>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/core/mpi/team.hpp"

namespace orbweaver::equations {

/// The staggered box scheme of a linearised loop problem on N nodes of a full period,
///
///   (y_(j+1) - y_j) / h - B_j (y_j + y_(j+1)) / 2 + C_j p = b_j,   j = 0 .. N-1,  y_N = y_0,
///   sum_j R_j . y_j + S p = a,
///
/// with small dense blocks B_j (d x d) and as many border unknowns p as border rows. Factored by orthogonal elimination
/// along the loop, which stays bounded however unstable the orbit is: O(N d^3) once, O(N d^2) a solve. Members of a team
/// each eliminate within a stretch of the loop; what is left couples the stretches' first nodes and is solved by all.
/// Solves share scratch space: one at a time.
class BoxScheme {
 public:
  static constexpr int most_borders = 4;

  struct Matrices {
    int dimension = 0;
    int nodes = 0;
    double spacing = 0.0;        ///< h
    int first = 0;               ///< `blocks` and `columns` begin with this box,
    int boxes = 0;               ///< and are of so many
    std::vector<double> blocks;  ///< B: entry (i, l) of box j at [(i d + l) boxes + j - first]
    Eigen::MatrixXd columns;     ///< C: (d boxes) x borders, entry i of box j at row i boxes + j - first
    Eigen::MatrixXd rows;        ///< R: borders x (d N), entry i of node j in column i N + j
    Eigen::MatrixXd corner;      ///< S: borders x borders
  };

  virtual ~BoxScheme() = default;
  BoxScheme() = default;
  BoxScheme(const BoxScheme&) = delete;
  BoxScheme& operator=(const BoxScheme&) = delete;
  BoxScheme(BoxScheme&&) = delete;
  BoxScheme& operator=(BoxScheme&&) = delete;

  /// Overwrites the right-hand side (b component-major, then a) with the solution (y, then p).
  virtual void solve(Eigen::VectorXd& right_side) const = 0;
  /// The same with the transposed matrix: the right-hand side is one of (y, p), the solution one of (b, a).
  virtual void solve_transposed(Eigen::VectorXd& right_side) const = 0;
};

/// The boxes that this rank eliminates: all without a team, or where the team is too large.
[[nodiscard]] core::Team::Part boxes_of(const core::Team* team, int nodes);

/// Factors; `matrices` holds the boxes of `boxes_of`. Throws core::NumericalError if the condensed system is singular,
/// MisuseError for more than `most_borders`. With a team, this and the solves are collective over it.
[[nodiscard]] std::unique_ptr<BoxScheme> factor_box_scheme(const BoxScheme::Matrices& matrices,
                                                           core::Team* team = nullptr);

}  // namespace orbweaver::equations
