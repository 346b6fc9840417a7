#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// Two coupled springs, told as a user would: (exp(y) - y - 1) w2^2 + (1 - exp(-x))^2 w1^2 / 2 + c x y^2 + f x^2 y^2/2,
/// with x = q/unit. The field loses digits near the origin, where exp(y) is 1 and y is little, and so does the energy.
class TodaSprings {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("toda_springs", "a Morse and a Toda spring, coupled", {"q", "y", "pq", "py"},
                           {"w1", "w2", "c", "f", "unit"});
  }

  static systems::Structure structure(const systems::Bound&) { return test::structure_in_plane(); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _w1(bound["w1"]), _w2(bound["w2"]), _c(bound["c"]), _f(bound["f"]), _unit(bound["unit"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::exp;
      const S x = z[0] / _unit, y = z[1];
      const S e = exp(-x);
      f[0] = z[2] * _unit * _unit;  // of a mass 1/unit^2
      f[1] = z[3];
      f[2] = -((1.0 - e) * e * _w1 * _w1 + y * y * _c + x * y * y * _f) / _unit;
      f[3] = -((exp(y) - 1.0) * _w2 * _w2 + x * y * _c * 2.0 + x * x * y * _f);
    }

    template <int, class S>
    S conserved(const S* z) const {
      using std::exp;
      const S x = z[0] / _unit, y = z[1];
      const S e = 1.0 - exp(-x);
      return (z[2] * z[2] * _unit * _unit + z[3] * z[3] + e * e * _w1 * _w1) * 0.5 + (exp(y) - y - 1.0) * _w2 * _w2 +
             x * y * y * _c + x * x * y * y * _f * 0.5;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] * _unit * _unit + z[3] * z[3];
    }

   private:
    P _w1, _w2, _c, _f, _unit;
  };
};

inline std::shared_ptr<const systems::System> toda_springs(const std::map<std::string, double>& parameters) {
  return systems::recorded<TodaSprings>(systems::bound_to(TodaSprings::info(), parameters, {}));
}

}  // namespace orbweaver::test
