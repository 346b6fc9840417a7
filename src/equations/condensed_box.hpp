#pragma once

#include <span>
#include <vector>

#include <Eigen/Dense>

#include "box_scheme.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::equations {

/// What elimination within the stretches leaves of a box scheme: a dense system for the nodes where stretches meet, and
/// the borders. Stretch k is between nodes k and k + 1 of this system; where the loop closes the last is between the
/// last and the first.
class CondensedBox {
 public:
  /// Of one stretch, as numbers one after the other, matrices by columns: the relation first y_k + next y_(k+1) +
  /// border p, then its share of the border rows on y_k and on y_(k+1).
  [[nodiscard]] static int relation_size(int dimension, int borders) {
    return 2 * dimension * dimension + 3 * dimension * borders;
  }

  /// `relations`: of each member its stretches', then its share of the corner (borders x borders, by columns). Throws
  /// NumericalError where the system is singular or not finite.
  void factor(int dimension, int members, int stretches_each, const std::vector<double>& relations,
              const BoxScheme::Matrices& m);

  [[nodiscard]] int size() const { return static_cast<int>(_lu.rows()); }
  [[nodiscard]] int nodes() const { return _nodes; }
  /// In place: nodes (or relations, with the end conditions behind), then borders.
  void solve(std::vector<double>& x) const;
  void solve_transposed(std::vector<double>& x) const;

 private:
  int _nodes = 0;
  Eigen::PartialPivLU<Eigen::MatrixXd> _lu;
  Eigen::MatrixXd _inverse;  // where the system is small
  mutable Eigen::VectorXd _solution;
};

}  // namespace orbweaver::equations
