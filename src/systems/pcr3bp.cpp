#include <cmath>

#include "model_system.hpp"

namespace orbweaver::systems {

/// The planar circular restricted three-body problem (Szebehely 1967, Theory of Orbits): a particle without mass in the
/// field of two bodies on circles, in the frame that turns with them. Units: the distance of the bodies, the mass of
/// both, and the time in which the frame turns by 1 rad. State x, y, vx, vy; bodies of masses 1 - mu at (-mu, 0) and mu
/// at (1 - mu, 0), at distances r1 and r2;
///   H = (vx^2 + vy^2)/2 - (x^2 + y^2)/2 - (1 - mu)/r1 - mu/r2,   momenta vx - y and vy + x.
/// Jacobi's constant is -2 H (some authors add mu (1 - mu)).
class Pcr3bp {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _mu(bound["mu"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::sqrt;
      const S from_1 = z[0] + _mu;
      const S from_2 = z[0] + (_mu - 1.0);
      const S square_y = z[1] * z[1];
      const S square_1 = from_1 * from_1 + square_y;
      const S square_2 = from_2 * from_2 + square_y;
      const S pull_1 = S(1.0) / (square_1 * sqrt(square_1)) * (1.0 - _mu);
      const S pull_2 = S(1.0) / (square_2 * sqrt(square_2)) * _mu;
      f[0] = z[2];
      f[1] = z[3];
      f[2] = z[3] * 2.0 + z[0] - from_1 * pull_1 - from_2 * pull_2;
      f[3] = z[2] * -2.0 + z[1] - z[1] * (pull_1 + pull_2);
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S kinetic = (z[2] * z[2] + z[3] * z[3]) * 0.5;
      const S centrifugal = (z[0] * z[0] + z[1] * z[1]) * 0.5;
      return kinetic - centrifugal - S(1.0) / distance(z[0] + _mu, z[1]) * (1.0 - _mu) -
             S(1.0) / distance(z[0] + (_mu - 1.0), z[1]) * _mu;
    }

    template <class S>
    S action_density(const S* z) const {
      return (z[2] - z[1]) * z[2] + (z[3] + z[0]) * z[3];
    }

    [[nodiscard]] double guard(int k, const double* z) const {
      return std::hypot(z[0] + (k == 0 ? _mu : _mu - 1.0), z[1]);
    }

   private:
    template <class S>
    static S distance(const S& x, const S& y) {
      using std::sqrt;
      return sqrt(x * x + y * y);
    }

    P _mu;
  };
};

ModelInfo Pcr3bp::info() {
  ModelInfo info;
  info.name = "pcr3bp";
  info.title = "Planar circular restricted three-body problem";
  info.state_names = {"x", "y", "vx", "vy"};
  info.winding_names = {"", "", "", ""};
  info.parameters = {
      {"mu", 0.01215058560962404, 0.0, 0.5, true, "1", "mass of the smaller body over the mass of both"}};
  return info;
}

Structure Pcr3bp::structure(const Bound& bound) {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
  const Eigen::Matrix4d half_turn = -Eigen::Matrix4d::Identity();
  Structure structure;
  structure.dimension = dimension;
  structure.conserved = {"energy"};
  const bool equal = bound["mu"] == 0.5;
  structure.guards = {{"r1", equal ? "the first body" : "the larger body"},
                      {"r2", equal ? "the second body" : "the smaller body"}};
  structure.reversors = {{"R", reverse}};
  // Equal bodies change places in half a turn.
  if (equal) {
    structure.equivariances = {{"S", half_turn}};
    structure.reversors.push_back({"RS", -reverse});
  }
  structure.symplectic = true;
  return structure;
}

template struct Registered<Pcr3bp>;

}  // namespace orbweaver::systems
