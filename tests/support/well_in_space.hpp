#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// What the structure of a WellInSpace declares besides that it goes the same ways backwards.
enum class InSpace {
  nothing,
  mirror,    ///< images in z
  triangle,  ///< images in z, and turns by a third about x
};

/// A particle of mass 1 in space, in a well of the terms c<ijk> x^i y^j z^k of second to fourth order that are even in
/// z, and in y too where `EvenInY`.
template <bool EvenInY, InSpace Declared>
class WellInSpace {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;

  struct Term {
    std::array<int, 3> powers;
    [[nodiscard]] std::string name() const { return fmt::format("c{}", fmt::join(powers, "")); }
  };

  static const std::vector<Term>& terms() {
    static const std::vector<Term> all = [] {
      std::vector<Term> out;
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; j += EvenInY ? 2 : 1)
          for (int k = 0; i + j + k <= 4; k += 2)
            if (i + j + k >= 2) out.push_back({{i, j, k}});
      return out;
    }();
    return all;
  }

  static systems::ModelInfo info() {
    std::vector<std::string> coefficients;
    for (const Term& term : terms()) coefficients.push_back(term.name());
    return test::described("well_in_space", "a particle in a well in space", {"x", "y", "z", "px", "py", "pz"},
                           coefficients, 0.0);
  }

  static systems::Structure structure(const systems::Bound&) {
    const auto diagonal = [](double x, double y, double z, double px, double py, double pz) {
      return Eigen::MatrixXd(Eigen::Matrix<double, 6, 1>{x, y, z, px, py, pz}.asDiagonal());
    };
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    const Eigen::MatrixXd back = diagonal(1, 1, 1, -1, -1, -1);
    const Eigen::MatrixXd mirror = diagonal(1, 1, -1, 1, 1, -1);
    structure.reversors = {{"R", back}};
    if (Declared == InSpace::mirror) {
      structure.equivariances = {{"Z", mirror}};
      structure.reversors.push_back({"RZ", back * mirror});
    } else if (Declared == InSpace::triangle) {
      Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(dimension, dimension);
      turn.block<2, 2>(1, 1) = Eigen::Rotation2Dd(2.0 * std::numbers::pi / 3.0).toRotationMatrix();
      turn.block<2, 2>(4, 4) = turn.block<2, 2>(1, 1);
      const Eigen::MatrixXd twice = turn * turn;
      structure.equivariances = {
          {"C", turn}, {"CC", twice}, {"Z", mirror}, {"ZC", mirror * turn}, {"ZCC", mirror * twice}};
      for (const systems::Symmetry& one : std::vector(structure.equivariances))
        structure.reversors.push_back({"R" + one.name, back * one.map.matrix});
    }
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) {
      for (const Term& term : terms()) _coefficients.push_back(bound[term.name()]);
    }

    template <class S>
    void field(const S* s, S* f) const {
      for (int i = 0; i < 3; ++i) {
        f[i] = s[3 + i];
        f[3 + i] = S(0.0);
      }
      for (std::size_t n = 0; n < _coefficients.size(); ++n)
        for (std::size_t i = 0; i < 3; ++i) {
          std::array<int, 3> powers = terms()[n].powers;
          const int power = powers[i]--;
          if (power > 0) f[3 + i] = f[3 + i] - monomial(s, powers) * _coefficients[n] * static_cast<double>(power);
        }
    }

    template <int, class S>
    S conserved(const S* s) const {
      S sum = action_density(s) * 0.5;
      for (std::size_t n = 0; n < _coefficients.size(); ++n)
        sum = sum + monomial(s, terms()[n].powers) * _coefficients[n];
      return sum;
    }

    template <class S>
    S action_density(const S* s) const {
      return s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    }

   private:
    template <class S>
    static S monomial(const S* s, const std::array<int, 3>& powers) {
      S product(1.0);
      for (std::size_t i = 0; i < 3; ++i)
        for (int n = 0; n < powers[i]; ++n) product = product * s[i];
      return product;
    }

    std::vector<P> _coefficients;
  };
};

/// Coefficients that are not given are 0.
template <class Well>
std::shared_ptr<const systems::System> well_in_space(const std::map<std::string, double>& coefficients) {
  return systems::recorded<Well>(systems::bound_to(Well::info(), coefficients, {}));
}

}  // namespace orbweaver::test
