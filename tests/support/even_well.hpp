#pragma once

#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// A particle of mass 1 in a well that is even in x: (k1 x^2 + k2 y^2)/2 + a x^2 y + b y^3 + c x^4 + d x^2 y^2 + e y^4.
class EvenWell {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("even_well", "a particle in a well that is even in x", {"x", "y", "px", "py"},
                           {"k1", "k2", "a", "b", "c", "d", "e"});
  }

  static systems::Structure structure(const systems::Bound&) {
    const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
    systems::Structure structure = test::structure_in_plane();
    structure.equivariances = {{"S", mirror}};
    structure.reversors.push_back({"RS", structure.reversors.front().map.matrix * mirror});
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _k1(bound["k1"]),
          _k2(bound["k2"]),
          _a(bound["a"]),
          _b(bound["b"]),
          _c(bound["c"]),
          _d(bound["d"]),
          _e(bound["e"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1];
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -x * _k1 - x * y * _a * 2.0 - x * x * x * _c * 4.0 - x * y * y * _d * 2.0;
      f[3] = -y * _k2 - x * x * _a - y * y * _b * 3.0 - x * x * y * _d * 2.0 - y * y * y * _e * 4.0;
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S x = z[0], y = z[1], xx = x * x, yy = y * y;
      return (z[2] * z[2] + z[3] * z[3] + xx * _k1 + yy * _k2) * 0.5 + xx * y * _a + yy * y * _b + xx * xx * _c +
             xx * yy * _d + yy * yy * _e;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }

   private:
    P _k1, _k2, _a, _b, _c, _d, _e;
  };
};

inline std::shared_ptr<const systems::System> even_well(const std::map<std::string, double>& parameters) {
  return systems::recorded<EvenWell>(systems::bound_to(EvenWell::info(), parameters, {}));
}

}  // namespace orbweaver::test
