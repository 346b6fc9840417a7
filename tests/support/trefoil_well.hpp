#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// A charge in a well with the symmetry of a triangle, in a magnetic field B r^2 across the plane: r^2/2 + a k
/// + b r^4/4 + c k^2 with k = x^2 y - y^3/3. Both small oscillations have the period 2 pi. All its symmetries are
/// declared.
class TrefoilWell {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("trefoil_well", "a charge in a well with three arms", {"x", "y", "vx", "vy"},
                           {"B", "a", "b", "c"});
  }

  static systems::Structure structure(const systems::Bound&) {
    const double h = std::sqrt(0.75);
    Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
    turn.block<2, 2>(0, 0) << -0.5, -h, h, -0.5;
    turn.block<2, 2>(2, 2) = turn.block<2, 2>(0, 0);
    const Eigen::Matrix4d back = Eigen::Vector4d(-1, 1, 1, -1).asDiagonal();
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    structure.equivariances = {{"T", turn}, {"TT", turn * turn}};
    structure.reversors = {{"R", back}, {"RT", back * turn}, {"RTT", back * turn * turn}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _B(bound["B"]), _a(bound["a"]), _b(bound["b"]), _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1], square = x * x + y * y, k = x * x * y - y * y * y * (1.0 / 3.0);
      const S slope = k * _c * 2.0 + _a;
      f[0] = z[2];
      f[1] = z[3];
      f[2] = z[3] * square * _B - x - x * y * 2.0 * slope - square * x * _b;
      f[3] = -z[2] * square * _B - y - (x * x - y * y) * slope - square * y * _b;
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S x = z[0], y = z[1], square = x * x + y * y, k = x * x * y - y * y * y * (1.0 / 3.0);
      return (z[2] * z[2] + z[3] * z[3] + square) * 0.5 + k * _a + square * square * _b * 0.25 + k * k * _c;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3] + (z[0] * z[3] - z[1] * z[2]) * (z[0] * z[0] + z[1] * z[1]) * _B * 0.25;
    }

   private:
    P _B, _a, _b, _c;
  };
};

inline std::shared_ptr<const systems::System> trefoil_well(const std::map<std::string, double>& parameters) {
  return systems::recorded<TrefoilWell>(systems::bound_to(TrefoilWell::info(), parameters, {}));
}

}  // namespace orbweaver::test
