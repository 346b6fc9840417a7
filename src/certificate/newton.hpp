#pragma once

#include <vector>

#include <Eigen/Dense>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::certificate {

/// One step of Newton's method for multiple shooting around a period: corrections x_m of the states and tau of the
/// period with
///
///     P_m x_m - x_(m+1) + f_(m+1) tau / M = e_m,   m = 0 ... M - 1,   x_M = x_0,
///
/// of least norm where more than one will do: along the flow and along the family. Orthogonal elimination from segment
/// to segment, so that no growth along the orbit is lost in rounding.
class NewtonSystem {
 public:
  /// `transitions`: P_m, d x d. `fields`: f_m at the M + 1 ends, the last being the first's. `rank` of the closing
  /// condition on x_0 and tau: d less the conserved quantities, each of which makes an equation follow from the others.
  NewtonSystem(const std::vector<Eigen::MatrixXd>& transitions, const std::vector<Eigen::VectorXd>& fields, int rank);

  struct Step {
    std::vector<Eigen::VectorXd> states;  ///< x_0 ... x_(M-1)
    double period = 0.0;                  ///< tau
  };
  /// `gaps`: e_m.
  [[nodiscard]] Step solve(const std::vector<Eigen::VectorXd>& gaps) const;

 private:
  using Matrix = Eigen::MatrixXd;

  /// Of x_m, 0 < m < M: Q^T (what stands before it), with R x_m + first x_0 + next x_(m+1) + period tau = right side.
  struct Pivot {
    Eigen::HouseholderQR<Matrix> factors;
    Matrix first;
    Matrix next;
    Eigen::VectorXd period;
  };
  int _dimension;
  int _rank;
  double _speed = 1.0;  ///< a change of the period counts as that of the states that it goes with
  std::vector<Pivot> _pivots;
  Eigen::JacobiSVD<Matrix> _closing;
};

}  // namespace orbweaver::certificate
