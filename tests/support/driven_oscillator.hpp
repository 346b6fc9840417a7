#pragma once

#include <cmath>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// x'' + d x' + a1 x + a2 x^2 + a3 x^3 + s sin x = c + F cos phi, phi' = w: a damped well or a pendulum with a torque.
class DrivenOscillator {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    systems::ModelInfo info = test::described("driven_oscillator", "a damped oscillator that is driven",
                                              {"x", "v", "phi"}, {"d", "a1", "a2", "a3", "s", "c", "F", "w"}, 0.0);
    info.winding_names = {"", "", "wphi"};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure = test::dissipative_structure(dimension);
    structure.driven = true;
    structure.angles = {2};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _d(bound["d"]),
          _a1(bound["a1"]),
          _a2(bound["a2"]),
          _a3(bound["a3"]),
          _s(bound["s"]),
          _c(bound["c"]),
          _drive(bound["F"]),
          _w(bound["w"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::cos;
      using std::sin;
      const S x = z[0];
      f[0] = z[1];
      f[1] = _c + cos(z[2]) * _drive - z[1] * _d - x * _a1 - x * x * _a2 - x * x * x * _a3 - sin(x) * _s;
      f[2] = S(1.0) * _w;
    }

   private:
    P _d, _a1, _a2, _a3, _s, _c, _drive, _w;
  };
};

}  // namespace orbweaver::test
