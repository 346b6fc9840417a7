#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// A particle of mass 1 in a magnetic field b (1 + e x) across the plane and a well k1 x^2/2 + k2 y^2/2 + a cubic with
/// the coefficients a1 .. a4 + q (x^4 + y^4 + 2 c x^2 y^2)/4, in canonical momenta. It declares no symmetry;
/// without the magnetic field it has a reversor all the same.
class MagneticWell {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("magnetic_well", "a particle in a magnetic field and a well", {"x", "y", "px", "py"},
                           {"k1", "k2", "b", "e", "a1", "a2", "a3", "a4", "q", "c"});
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _k1(bound["k1"]),
          _k2(bound["k2"]),
          _b(bound["b"]),
          _e(bound["e"]),
          _a1(bound["a1"]),
          _a2(bound["a2"]),
          _a3(bound["a3"]),
          _a4(bound["a4"]),
          _q(bound["q"]),
          _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1];
      const S vy = speed_y(z);
      f[0] = z[2];
      f[1] = vy;
      f[2] = vy * (1.0 + x * _e) * _b -
             (x * _k1 + x * x * _a1 + x * y * _a2 * 2.0 + y * y * _a3 + (x * x * x + x * y * y * _c) * _q);
      f[3] = -(y * _k2 + x * x * _a2 + x * y * _a3 * 2.0 + y * y * _a4 + (y * y * y + x * x * y * _c) * _q);
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S x = z[0], y = z[1];
      const S vy = speed_y(z);
      return (z[2] * z[2] + vy * vy + x * x * _k1 + y * y * _k2) * 0.5 + x * x * x * _a1 / 3.0 + x * x * y * _a2 +
             x * y * y * _a3 + y * y * y * _a4 / 3.0 +
             (x * x * x * x + y * y * y * y + x * x * y * y * _c * 2.0) * _q * 0.25;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * speed_y(z);
    }

   private:
    template <class S>
    S speed_y(const S* z) const {
      return z[3] - (z[0] + z[0] * z[0] * _e * 0.5) * _b;
    }

    P _k1, _k2, _b, _e, _a1, _a2, _a3, _a4, _q, _c;
  };
};

inline std::shared_ptr<const systems::System> magnetic_well(const std::map<std::string, double>& parameters) {
  return systems::recorded<MagneticWell>(systems::bound_to(MagneticWell::info(), parameters, {}));
}

}  // namespace orbweaver::test
