#include <cmath>
#include <limits>

#include "model_system.hpp"

namespace orbweaver::systems {

/// Two point masses on massless rods, the second hanging from the first. State th1, th2 (rad from the downward
/// vertical), w1, w2 (rad/s). With M = m1 + m2 and d = th1 - th2 the Lagrangian is
///   L = M l1^2 w1^2 / 2 + m2 l2^2 w2^2 / 2 + m2 l1 l2 w1 w2 cos d + M g l1 cos th1 + m2 g l2 cos th2,
/// whose two equations are solved here for the angular accelerations (determinant m1 + m2 sin^2 d > 0).
class DoublePendulum {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _m1(bound["m1"]), _m2(bound["m2"]), _l1(bound["l1"]), _l2(bound["l2"]), _g(bound["g"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::cos;
      using std::sin;
      const P mass = _m1 + _m2;
      const S d = z[0] - z[1];
      const S sin_d = sin(d);
      const S cos_d = cos(d);
      const S sin_1 = sin(z[0]);
      const S sin_2 = sin(z[1]);
      const S swing_1 = z[2] * z[2] * _l1;
      const S swing_2 = z[3] * z[3] * _l2;
      const S share = S(1.0) / (sin_d * sin_d * _m2 + _m1);
      const S pull_1 = (sin_2 * cos_d * _m2 - sin_1 * mass) * _g - sin_d * (swing_1 * cos_d + swing_2) * _m2;
      const S pull_2 = (sin_1 * cos_d - sin_2) * (mass * _g) + sin_d * (swing_1 * mass + swing_2 * cos_d * _m2);
      f[0] = z[2];
      f[1] = z[3];
      f[2] = pull_1 * share * (1.0 / _l1);
      f[3] = pull_2 * share * (1.0 / _l2);
    }

    template <int, class S>
    S conserved(const S* z) const {
      using std::cos;
      const S height = cos(z[0]) * ((_m1 + _m2) * _l1) + cos(z[1]) * (_m2 * _l2);
      return action_density(z) * 0.5 - height * _g;
    }

    template <class S>
    S action_density(const S* z) const {
      using std::cos;
      const S d = z[0] - z[1];
      return z[2] * z[2] * ((_m1 + _m2) * _l1 * _l1) + z[3] * z[3] * (_m2 * _l2 * _l2) +
             z[2] * z[3] * cos(d) * (2.0 * _m2 * _l1 * _l2);
    }

   private:
    P _m1;
    P _m2;
    P _l1;
    P _l2;
    P _g;
  };
};

ModelInfo DoublePendulum::info() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "double_pendulum";
  info.title = "Ideal double pendulum";
  info.state_names = {"th1", "th2", "w1", "w2"};
  info.winding_names = {"n1", "n2", "", ""};
  info.parameters = {
      {"m1", 1.0, 0.0, inf, true, "kg", "mass of the inner bob"},
      {"m2", 1.0, 0.0, inf, true, "kg", "mass of the outer bob"},
      {"l1", 1.0, 0.0, inf, true, "m", "length of the inner rod"},
      {"l2", 1.0, 0.0, inf, true, "m", "length of the outer rod"},
      {"g", 1.0, 0.0, inf, true, "m/s^2", "gravity"},
  };
  return info;
}

Structure DoublePendulum::structure(const Bound&) {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  const Eigen::Matrix4d mirror = -Eigen::Matrix4d::Identity();
  Structure structure;
  structure.dimension = dimension;
  structure.angles = {0, 1};
  structure.conserved = {"energy"};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", -reverse}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<DoublePendulum>;

}  // namespace orbweaver::systems
