#include <cmath>
#include <numbers>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

/// A star in the plane of a galaxy, H = (px^2 + py^2 + x^2 + y^2) / 2 + x^2 y - y^3 / 3 (Henon and Heiles 1964,
/// doi:10.1086/109234), state x, y, px, py. The potential has the symmetries of an equilateral triangle; orbits stay
/// bounded for energies below 1/6.
class HenonHeiles {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>&) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -(z[0] + z[0] * z[1] * 2.0);
      f[3] = z[1] * z[1] - z[0] * z[0] - z[1];
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S square_x = z[0] * z[0];
      const S square_y = z[1] * z[1];
      return (action_density(z) + square_x + square_y) * 0.5 + square_x * z[1] - square_y * z[1] * (S(1.0) / 3.0);
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }
  };
};

namespace {

/// A linear map of the plane, acting on positions and on momenta alike.
Eigen::Matrix4d on_phase_space(const Eigen::Matrix2d& plane) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  matrix.topLeftCorner<2, 2>() = plane;
  matrix.bottomRightCorner<2, 2>() = plane;
  return matrix;
}

}  // namespace

ModelInfo HenonHeiles::info() {
  ModelInfo info;
  info.name = "henon_heiles";
  info.title = "Henon-Heiles system";
  info.meaning = "a star in the plane of a galaxy, in a potential with the symmetries of a triangle";
  info.state_names = {"x", "y", "px", "py"};
  info.winding_names = {"", "", "", ""};
  return info;
}

Structure HenonHeiles::structure(const Bound&) {
  Eigen::Matrix2d third_turn;
  third_turn << -0.5, -0.5 * std::numbers::sqrt3, 0.5 * std::numbers::sqrt3, -0.5;
  const Eigen::Matrix4d c = on_phase_space(third_turn);
  const Eigen::Matrix4d cc = on_phase_space(third_turn.transpose());
  const Eigen::Matrix4d s = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
  const Eigen::Matrix4d r = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  Structure structure;
  structure.dimension = dimension;
  structure.conserved = {"energy"};
  structure.equivariances = {{"C", c}, {"CC", cc}, {"S", s}, {"SC", s * c}, {"SCC", s * cc}};
  // R C and R CC reverse time too, but are no involutions and fix only the origin: no orbit starts on their fixed
  // space.
  structure.reversors = {{"R", r}, {"RS", r * s}, {"RSC", r * s * c}, {"RSCC", r * s * cc}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<HenonHeiles>;

}  // namespace orbweaver::systems
