#include <algorithm>
#include <cmath>
#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

/// Three point masses in the plane under Newtonian gravity, G = 1, without the motion of their centre of mass and
/// without the angle by which all turn together: its momentum is the angular momentum L, which is a parameter. The
/// frame is that of bodies 1 and 2: its x axis points from 1 to 2, r is their distance, and (x, y) is body 3 as seen
/// from the centre of mass of both (Jacobi's vectors; Whittaker 1937, Analytical Dynamics, 13). State r, x, y and
/// their momenta pr, px, py. With M = m1 + m2, the reduced masses k = m1 m2/M and K = m3 M/(M + m3), the part l = x
/// py - y px of body 3 in L, and d1, d2 the distances of body 3 from the others:
///   H = pr^2/(2 k) + (L - l)^2/(2 k r^2) + (px^2 + py^2)/(2 K) - m1 m2/r - m1 m3/d1 - m2 m3/d2.
/// The frame turns at the rate (L - l)/(k r^2).
class ThreeBodies {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _L(bound["L"]),
          _pull12(bound["m1"] * bound["m2"]),
          _pull13(bound["m1"] * bound["m3"]),
          _pull23(bound["m2"] * bound["m3"]),
          _part1(bound["m1"] / (bound["m1"] + bound["m2"])),
          _part2(bound["m2"] / (bound["m1"] + bound["m2"])),
          _reduced(bound["m1"] * _part2),
          _reduced3(bound["m3"] * (bound["m1"] + bound["m2"]) / (bound["m1"] + bound["m2"] + bound["m3"])) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S rate = turning(z);
      const S x1 = z[1] + z[0] * _part2;
      const S x2 = z[1] - z[0] * _part1;
      const S pull1 = over_cube(x1, z[2]) * _pull13;
      const S pull2 = over_cube(x2, z[2]) * _pull23;
      f[0] = z[3] / _reduced;
      f[1] = z[4] / _reduced3 + z[2] * rate;
      f[2] = z[5] / _reduced3 - z[1] * rate;
      f[3] =
          z[0] * rate * rate * _reduced - S(1.0) / (z[0] * z[0]) * _pull12 - x1 * pull1 * _part2 + x2 * pull2 * _part1;
      f[4] = z[5] * rate - x1 * pull1 - x2 * pull2;
      f[5] = -(z[4] * rate) - z[2] * (pull1 + pull2);
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S across = turning(z) * z[0];
      const S inner = z[3] * z[3] / _reduced + across * across * _reduced;
      const S outer = (z[4] * z[4] + z[5] * z[5]) / _reduced3;
      return (inner + outer) * 0.5 - S(1.0) / z[0] * _pull12 - over_distance(z[1] + z[0] * _part2, z[2]) * _pull13 -
             over_distance(z[1] - z[0] * _part1, z[2]) * _pull23;
    }

    /// Of r, x and y; the angle of the frame adds L times the angle by which it turns in a period.
    template <class S>
    S action_density(const S* z) const {
      const S turned = (z[2] * z[4] - z[1] * z[5]) * turning(z);
      return z[3] * z[3] / _reduced + (z[4] * z[4] + z[5] * z[5]) / _reduced3 + turned;
    }

    [[nodiscard]] double guard(int k, const double* z) const {
      if (k == 0) return z[0];
      return std::hypot(k == 1 ? z[1] + z[0] * _part2 : z[1] - z[0] * _part1, z[2]);
    }

   private:
    /// The rate at which the frame turns.
    template <class S>
    S turning(const S* z) const {
      return (z[2] * z[4] - z[1] * z[5] + _L) / (z[0] * z[0] * _reduced);
    }
    template <class S>
    static S over_distance(const S& x, const S& y) {
      using std::sqrt;
      return S(1.0) / sqrt(x * x + y * y);
    }
    template <class S>
    static S over_cube(const S& x, const S& y) {
      using std::sqrt;
      const S square = x * x + y * y;
      return S(1.0) / (square * sqrt(square));
    }

    P _L;
    P _pull12, _pull13, _pull23;
    P _part1, _part2;  // of bodies 1 and 2 in the mass of both
    P _reduced, _reduced3;
  };
};

ModelInfo ThreeBodies::info() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "three_bodies";
  info.title = "Three bodies in the plane";
  info.meaning = "three point masses that attract each other, in the frame of the first two";
  info.state_names = {"r", "x", "y", "pr", "px", "py"};
  info.winding_names.assign(info.state_names.size(), "");
  info.parameters = {{"m1", 1.0, 0.0, inf, true, "1", "mass of the first body"},
                     {"m2", 1.0, 0.0, inf, true, "1", "mass of the second body"},
                     {"m3", 1.0, 0.0, inf, true, "1", "mass of the third body"},
                     {"L", 0.0, -inf, inf, false, "1", "angular momentum about the centre of mass"}};
  return info;
}

Structure ThreeBodies::structure(const Bound& bound) {
  using State = Eigen::Matrix<double, dimension, 1>;
  const auto on_states = [](double x, double y, double pr, double px, double py) {
    return Eigen::MatrixXd((State() << 1, x, y, pr, px, py).finished().asDiagonal());
  };
  // A symmetry of some parameter values alone is none of families along which these move.
  const auto stays = [&](const char* name) {
    const std::vector<std::string>& free = bound.scalars.free;
    return std::find(free.begin(), free.end(), name) == free.end();
  };
  const Eigen::MatrixXd reverse = on_states(1, -1, -1, -1, 1);
  const Eigen::MatrixXd mirror = on_states(1, -1, 1, 1, -1);
  const Eigen::MatrixXd exchange = on_states(-1, -1, 1, -1, -1);
  const bool mirrors = bound["L"] == 0.0 && stays("L");
  const bool exchanges = bound["m1"] == bound["m2"] && stays("m1") && stays("m2");
  Structure structure;
  structure.dimension = dimension;
  structure.conserved = {"energy"};
  structure.guards = {{"r12", "body 1 with body 2"}, {"r13", "body 1 with body 3"}, {"r23", "body 2 with body 3"}};
  structure.reversors = {{"R", reverse}};
  if (mirrors) {
    structure.equivariances.push_back({"Y", mirror});
    structure.reversors.push_back({"RY", reverse * mirror});
  }
  if (exchanges) {
    structure.equivariances.push_back({"S", exchange});
    structure.reversors.push_back({"RS", reverse * exchange});
  }
  if (mirrors && exchanges) {
    structure.equivariances.push_back({"SY", exchange * mirror});
    structure.reversors.push_back({"RSY", reverse * exchange * mirror});
  }
  structure.symplectic = true;
  return structure;
}

template struct Registered<ThreeBodies>;

}  // namespace orbweaver::systems
