#pragma once

#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// A particle of mass 1 in a well without symmetry: (w1^2 x^2 + w2^2 y^2)/2 + a x^3/3 + b x^2 y + c x y^2 + d y^3/3
/// + e x^4/4 + f x^2 y^2/2 + g y^4/4.
class UnevenWell {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("uneven_well", "a particle in a well without symmetry", {"x", "y", "px", "py"},
                           {"w1", "w2", "a", "b", "c", "d", "e", "f", "g"});
  }

  static systems::Structure structure(const systems::Bound&) { return test::structure_in_plane(); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _w1(bound["w1"]),
          _w2(bound["w2"]),
          _a(bound["a"]),
          _b(bound["b"]),
          _c(bound["c"]),
          _d(bound["d"]),
          _e(bound["e"]),
          _f(bound["f"]),
          _g(bound["g"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1];
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -x * _w1 * _w1 - x * x * _a - x * y * _b * 2.0 - y * y * _c - x * x * x * _e - x * y * y * _f;
      f[3] = -y * _w2 * _w2 - x * x * _b - x * y * _c * 2.0 - y * y * _d - x * x * y * _f - y * y * y * _g;
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S x = z[0], y = z[1], xx = x * x, yy = y * y;
      const S quadratic = (z[2] * z[2] + z[3] * z[3] + xx * _w1 * _w1 + yy * _w2 * _w2) * 0.5;
      const S cubic = (xx * x * _a + yy * y * _d) * (1.0 / 3.0) + xx * y * _b + x * yy * _c;
      return quadratic + cubic + xx * xx * _e * 0.25 + xx * yy * _f * 0.5 + yy * yy * _g * 0.25;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }

   private:
    P _w1, _w2, _a, _b, _c, _d, _e, _f, _g;
  };
};

inline std::shared_ptr<const systems::System> uneven_well(const std::map<std::string, double>& parameters) {
  return systems::recorded<UnevenWell>(systems::bound_to(UnevenWell::info(), parameters, {}));
}

}  // namespace orbweaver::test
