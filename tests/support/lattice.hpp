#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/reduced_system.hpp"

namespace orbweaver::test {

/// V(r) = r^2/2 + a r^3/3 + b r^4/4 of Fermi, Pasta, Ulam and Tsingou.
template <class P, class S>
S bond_energy(const S& r, const P& a, const P& b) {
  return r * r * (r * (r * b * 0.25 + a / 3.0) + 0.5);
}
template <class P, class S>
S bond_force(const S& r, const P& a, const P& b) {
  return r * (r * (r * b + a) + 1.0);
}

inline std::vector<systems::Parameter> bond_parameters() {
  constexpr double any = std::numeric_limits<double>::infinity();
  return {{"a", 0.25, -any, any, false, "1", "cubic coefficient of a bond"},
          {"b", 1.0, -any, any, false, "1", "quartic coefficient of a bond"},
          {"closing", 1.0, 0.0, any, false, "1", "strength of the bond that closes the ring"}};
}

/// Three particles of masses 1, m2, 1, whose bonds make a ring (closing = 1), or a free chain (closing = 0).
/// Its momentum is conserved, and held at the parameter of that name.
class Lattice {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 2;

  static systems::ModelInfo info() {
    systems::ModelInfo info;
    info.name = "lattice";
    info.title = "A lattice of three particles";
    info.meaning = "three particles on a line, each bound to the next";
    info.state_names = {"x1", "x2", "x3", "p1", "p2", "p3"};
    info.winding_names = std::vector<std::string>(6);
    info.parameters = bond_parameters();
    constexpr double any = std::numeric_limits<double>::infinity();
    info.parameters.push_back({"m2", 1.0, 0.0, any, true, "1", "mass of the second particle"});
    info.parameters.push_back({"momentum", 0.0, -any, any, false, "1", "total momentum"});
    return info;
  }

  static systems::Structure structure(const systems::Bound& bound) {
    const auto permuted = [](int first, int second, int third, double places, double momenta) {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
      const int images[] = {first, second, third};
      for (int n = 0; n < 3; ++n) {
        matrix(n, images[n]) = places;
        matrix(3 + n, 3 + images[n]) = momenta;
      }
      return matrix;
    };
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy", "momentum"};
    structure.symplectic = true;
    structure.equivariances = {{"M", permuted(2, 1, 0, -1.0, -1.0)}};
    structure.reversors = {{"R", permuted(0, 1, 2, 1.0, -1.0)}, {"RM", permuted(2, 1, 0, -1.0, 1.0)}};
    if (bound["closing"] == 1.0 && bound["m2"] == 1.0) {
      structure.equivariances = {{"C", permuted(1, 2, 0, 1.0, 1.0)},
                                 {"CC", permuted(2, 0, 1, 1.0, 1.0)},
                                 {"M", permuted(2, 1, 0, -1.0, -1.0)},
                                 {"MC", permuted(1, 0, 2, -1.0, -1.0)},
                                 {"MCC", permuted(0, 2, 1, -1.0, -1.0)}};
      structure.reversors = {{"R", permuted(0, 1, 2, 1.0, -1.0)},
                             {"RM", permuted(2, 1, 0, -1.0, 1.0)},
                             {"RMC", permuted(1, 0, 2, -1.0, 1.0)},
                             {"RMCC", permuted(0, 2, 1, -1.0, 1.0)}};
    }
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _a(bound["a"]), _b(bound["b"]), _closing(bound["closing"]), _m2(bound["m2"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S first = bond_force(S(z[1] - z[0]), _a, _b);
      const S second = bond_force(S(z[2] - z[1]), _a, _b);
      const S third = bond_force(S(z[0] - z[2]), _a, _b) * _closing;
      f[0] = z[3];
      f[1] = z[4] / _m2;
      f[2] = z[5];
      f[3] = first - third;
      f[4] = second - first;
      f[5] = third - second;
    }

    template <int K, class S>
    S conserved(const S* z) const {
      if constexpr (K == 1)
        return z[3] + z[4] + z[5];
      else
        return (z[3] * z[3] + z[4] * z[4] / _m2 + z[5] * z[5]) * 0.5 + bond_energy(S(z[1] - z[0]), _a, _b) +
               bond_energy(S(z[2] - z[1]), _a, _b) + bond_energy(S(z[0] - z[2]), _a, _b) * _closing;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[3] * z[3] + z[4] * z[4] / _m2 + z[5] * z[5];
    }

   private:
    P _a, _b, _closing, _m2;
  };
};

/// The same with masses of 1, and the centre of mass taken out by hand: Jacobi's coordinates
///   u = (x1 - x2)/sqrt 2,  v = (x1 + x2 - 2 x3)/sqrt 6  and their momenta.
class LatticeByHand {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    systems::ModelInfo info;
    info.name = "lattice_by_hand";
    info.title = "A lattice of three particles without its centre of mass";
    info.meaning = "three particles on a line, each bound to the next";
    info.state_names = {"u", "v", "pu", "pv"};
    info.winding_names = std::vector<std::string>(4);
    info.parameters = bond_parameters();
    return info;
  }

  static systems::Structure structure(const systems::Bound& bound) {
    // Rows: u, v by x1, x2, x3.
    Eigen::MatrixXd jacobi(2, 3);
    jacobi << 1.0, -1.0, 0.0, 1.0, 1.0, -2.0;
    jacobi.row(0) /= std::sqrt(2.0);
    jacobi.row(1) /= std::sqrt(6.0);
    const auto told = [&](const systems::Symmetry& whole) {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4, 4);
      matrix.topLeftCorner(2, 2) = jacobi * whole.map.matrix.topLeftCorner(3, 3) * jacobi.transpose();
      matrix.bottomRightCorner(2, 2) = jacobi * whole.map.matrix.bottomRightCorner(3, 3) * jacobi.transpose();
      return systems::Symmetry{whole.name, matrix};
    };
    systems::Bound as_whole = bound;
    as_whole.parameters["m2"] = 1.0;
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    for (const systems::Symmetry& s : Lattice::structure(as_whole).equivariances)
      structure.equivariances.push_back(told(s));
    for (const systems::Symmetry& r : Lattice::structure(as_whole).reversors) structure.reversors.push_back(told(r));
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _a(bound["a"]), _b(bound["b"]), _closing(bound["closing"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::sqrt;
      const S first = bond_force(stretch_first(z), _a, _b);
      const S second = bond_force(stretch_second(z), _a, _b);
      const S third = bond_force(stretch_third(z), _a, _b) * _closing;
      f[0] = z[2];
      f[1] = z[3];
      f[2] = (first * 2.0 - second - third) / sqrt(S(2.0));
      f[3] = (second - third) * sqrt(S(1.5));
    }

    template <int, class S>
    S conserved(const S* z) const {
      return (z[2] * z[2] + z[3] * z[3]) * 0.5 + bond_energy(stretch_first(z), _a, _b) +
             bond_energy(stretch_second(z), _a, _b) + bond_energy(stretch_third(z), _a, _b) * _closing;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }

   private:
    // x2 - x1, x3 - x2, x1 - x3, with all digits of the roots.
    template <class S>
    static S stretch_first(const S* z) {
      using std::sqrt;
      return -z[0] * sqrt(S(2.0));
    }
    template <class S>
    static S stretch_second(const S* z) {
      using std::sqrt;
      return z[0] / sqrt(S(2.0)) - z[1] * sqrt(S(1.5));
    }
    template <class S>
    static S stretch_third(const S* z) {
      using std::sqrt;
      return z[0] / sqrt(S(2.0)) + z[1] * sqrt(S(1.5));
    }

    P _a, _b, _closing;
  };
};

/// A particle of mass 1 in the potential r^2/2 + b r^4/4 of the plane, in polar coordinates: its angular momentum is
/// the coordinate L, and held at the parameter of that name.
class CentralField {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 2;

  static systems::ModelInfo info() {
    systems::ModelInfo info;
    info.name = "central_field";
    info.title = "A particle in a central field";
    info.meaning = "a particle in the plane on a spring that hardens";
    info.state_names = {"r", "phi", "pr", "pphi"};
    info.winding_names = {"", "n", "", ""};
    constexpr double any = std::numeric_limits<double>::infinity();
    info.parameters = {{"b", 1.0, 0.0, any, false, "1", "how much the spring hardens"},
                       {"L", 1.0, -any, any, false, "1", "angular momentum"}};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.angles = {1};
    structure.conserved = {"energy", "L"};
    structure.symplectic = true;
    structure.guards = {{"r", "the centre"}};
    structure.equivariances = {{"M", Eigen::Vector4d(1.0, -1.0, 1.0, -1.0).asDiagonal().toDenseMatrix()}};
    structure.reversors = {{"R", Eigen::Vector4d(1.0, 1.0, -1.0, -1.0).asDiagonal().toDenseMatrix()},
                           {"RM", Eigen::Vector4d(1.0, -1.0, -1.0, 1.0).asDiagonal().toDenseMatrix()}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _b(bound["b"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[2];
      f[1] = z[3] / (z[0] * z[0]);
      f[2] = z[3] * z[3] / (z[0] * z[0] * z[0]) - z[0] - z[0] * z[0] * z[0] * _b;
      f[3] = z[3] * 0.0;
    }

    template <int K, class S>
    S conserved(const S* z) const {
      if constexpr (K == 1) return z[3] * 1.0;
      const S r2 = z[0] * z[0];
      return (z[2] * z[2] + z[3] * z[3] / r2 + r2 + r2 * r2 * _b * 0.5) * 0.5;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3] / (z[0] * z[0]);
    }

    template <class S>
    S guard(int, const S* z) const {
      return z[0];
    }

   private:
    P _b;
  };
};

/// As make_system hands it out.
template <class Model>
std::shared_ptr<const systems::System> reduced_model(const std::map<std::string, double>& parameters = {},
                                                     const systems::FamilyScalars& scalars = {}) {
  return systems::reduced(systems::recorded<Model>(systems::bound_to(Model::info(), parameters, {}, scalars)));
}

}  // namespace orbweaver::test
