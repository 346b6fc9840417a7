#include <cmath>
#include <limits>

#include "model_system.hpp"

namespace orbweaver::systems {

/// A point mass on a massless spring (elastic pendulum) in a vertical plane. State x, y (m from the suspension, y
/// upwards), vx, vy. With r = |(x, y)|,
///   H = mass (vx^2 + vy^2)/2 + stiffness (r - length)^2/2 + mass gravity y.
/// At rest it hangs at y = -(length + mass gravity/stiffness), where it oscillates up and down with the frequency
/// sqrt(stiffness/mass) and swings with the frequency sqrt(gravity/|y|). These are 2:1 if
///   stiffness length = 3 mass gravity,
class SwingingSpring {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _mass(bound["mass"]), _stiffness(bound["stiffness"]), _length(bound["length"]), _gravity(bound["gravity"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::sqrt;
      const S r = sqrt(z[0] * z[0] + z[1] * z[1]);
      const S pull = (S(1.0) - S(1.0) / r * _length) * (_stiffness / _mass);
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -(z[0] * pull);
      f[3] = -(z[1] * pull) - _gravity;
    }

    template <int, class S>
    S conserved(const S* z) const {
      using std::sqrt;
      const S stretch = sqrt(z[0] * z[0] + z[1] * z[1]) - _length;
      return (action_density(z) + stretch * stretch * _stiffness) * 0.5 + z[1] * (_mass * _gravity);
    }

    template <class S>
    S action_density(const S* z) const {
      return (z[2] * z[2] + z[3] * z[3]) * _mass;
    }

    [[nodiscard]] double guard(int, const double* z) const { return std::hypot(z[0], z[1]); }

   private:
    P _mass;
    P _stiffness;
    P _length;
    P _gravity;
  };
};

ModelInfo SwingingSpring::info() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "swinging_spring";
  info.title = "Swinging spring";
  info.state_names = {"x", "y", "vx", "vy"};
  info.winding_names = {"", "", "", ""};
  info.parameters = {
      {"mass", 1.0, 0.0, inf, true, "kg", "mass of the bob"},
      {"stiffness", 3.0, 0.0, inf, true, "N/m", "stiffness of the spring"},
      {"length", 1.0, 0.0, inf, true, "m", "length of the spring without load"},
      {"gravity", 1.0, 0.0, inf, true, "m/s^2", "gravity"},
  };
  return info;
}

Structure SwingingSpring::structure(const Bound&) {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
  Structure structure;
  structure.dimension = dimension;
  structure.conserved = {"energy"};
  structure.guards = {{"r", "the point of suspension"}};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", reverse * mirror}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<SwingingSpring>;

}  // namespace orbweaver::systems
