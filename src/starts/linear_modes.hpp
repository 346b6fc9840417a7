#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The loop problem linearised at a fixed point, one harmonic k at a time: M(T) = i k (2 pi / T) - A, singular where
/// the equilibrium has oscillations z = Re(v e^{iks}) of period T.
class LinearModes {
 public:
  LinearModes(const systems::System& system, std::span<const double> fixed_point);

  struct Root {
    double period;
    int multiplicity;         ///< dimension of the complex kernel
    double residual;          ///< the largest singular value of M that should vanish
    Eigen::MatrixXcd kernel;  ///< one vector a column
  };

  /// The roots of harmonic k in [low, high], seen as a dip at `near`: zeros of the signed function Re tr(g g'^-1),
  /// where g(T) is the block that borders M (docs/mathematics.md, "Sweep"). Empty where the function has no sign change
  /// or M stays regular. Where several singular values are small but do not vanish together the bracket is divided.
  [[nodiscard]] std::vector<Root> roots(int k, double low, double near, double high, int depth = 0) const;

  /// The right singular vector of the smallest singular value of M(T) at harmonic k.
  [[nodiscard]] Eigen::VectorXcd smallest_right_singular_vector(int k, double period) const;

  /// |A|, the scale of residuals.
  [[nodiscard]] double scale() const { return _a.norm(); }

 private:
  [[nodiscard]] Eigen::MatrixXcd matrix(int k, double period) const;
  [[nodiscard]] std::optional<Root> bordered_root(int k, double low, double near, double high,
                                                  Eigen::Index borders) const;
  Eigen::MatrixXd _a;
};

}  // namespace orbweaver::starts
