#pragma once

#include <vector>

#include <Eigen/Dense>

#include "orbweaver/starts/sampled_eigenvalues.hpp"

namespace orbweaver::starts {

/// The smallest eigenvalue of the Hessian of a constant loop at a fixed point with Jacobian A, over all coefficients up
/// to harmonic `cutoff`, period held: the least of the squared singular values of i k (2 pi/T) - A, twice those for
/// k = 0; or over the odd harmonics alone. It remembers values of nearby periods, which spare it most harmonics; the
/// result does not depend on them.
class ConstantLoopHessian {
 public:
  ConstantLoopHessian(const Eigen::MatrixXd& jacobian, int cutoff, Harmonics harmonics = Harmonics::all);

  struct Smallest {
    double eigenvalue;
    int harmonic;  ///< that carries its eigenvector; the lowest of several
  };
  [[nodiscard]] Smallest smallest(double period);

  /// The right singular vector of the smallest singular value of i (2 pi/T) - A.
  [[nodiscard]] Eigen::VectorXcd first_harmonic(double period) const;

 private:
  struct Known {
    double rate;
    double singular_value;
  };
  [[nodiscard]] Eigen::MatrixXcd block(double rate) const;

  Eigen::MatrixXd _a;
  double _mean;               // the smallest singular value of A; infinite where k = 0 is left out
  double _largest;            // and the largest
  int _every;                 // harmonics 1, 1 + every, ...
  std::vector<Known> _known;  // the last of each of them
};

}  // namespace orbweaver::starts
