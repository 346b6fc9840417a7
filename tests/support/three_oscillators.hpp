#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// Three oscillators at 1 : 2 : 3, with the two couplings of third order that resonate:
///   H = (p1^2 + p2^2 + p3^2)/2 + (q1^2 + 4 q2^2 + 9 q3^2)/2 + (q1^2 q2 + q1 q2 q3)/10.
class ThreeOscillators {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("three_oscillators", "three oscillators at 1 : 2 : 3", {"q1", "q2", "q3", "p1", "p2", "p3"});
  }

  static systems::Structure structure(const systems::Bound&) {
    Eigen::VectorXd back(6);
    back << 1, 1, 1, -1, -1, -1;
    Eigen::VectorXd turned(6);
    turned << -1, 1, -1, -1, 1, -1;
    const Eigen::MatrixXd reversor = back.asDiagonal();
    const Eigen::MatrixXd half = turned.asDiagonal();
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    structure.equivariances = {{"S", half}};
    structure.reversors = {{"R", reversor}, {"RS", Eigen::MatrixXd(half * reversor)}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>&) {}

    template <class S>
    void field(const S* z, S* f) const {
      for (int i = 0; i < 3; ++i) f[i] = z[3 + i];
      f[3] = -z[0] - (z[0] * z[1] * 2.0 + z[1] * z[2]) / S(10.0);
      f[4] = -z[1] * 4.0 - (z[0] * z[0] + z[0] * z[2]) / S(10.0);
      f[5] = -z[2] * 9.0 - z[0] * z[1] / S(10.0);
    }

    template <int, class S>
    S conserved(const S* z) const {
      return (action_density(z) + z[0] * z[0] + z[1] * z[1] * 4.0 + z[2] * z[2] * 9.0) * 0.5 +
             z[0] * z[1] * (z[0] + z[2]) / S(10.0);
    }

    template <class S>
    S action_density(const S* z) const {
      return z[3] * z[3] + z[4] * z[4] + z[5] * z[5];
    }
  };
};

}  // namespace orbweaver::test
