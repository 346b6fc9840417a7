#pragma once

#include <map>
#include <memory>
#include <string>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// A particle of mass 1 in two wells, one deeper by t: x^4/4 - x^2/2 + t x + w y^2/2 + k x y^2 + c x^2 y.
class DoubleWell {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("double_well", "a particle in two wells", {"x", "y", "px", "py"}, {"t", "w", "k", "c"});
  }

  static systems::Structure structure(const systems::Bound&) { return test::structure_in_plane(); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _t(bound["t"]), _w(bound["w"]), _k(bound["k"]), _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1];
      f[0] = z[2];
      f[1] = z[3];
      f[2] = x - x * x * x - S(1.0) * _t - y * y * _k - x * y * _c * 2.0;
      f[3] = -y * _w - x * y * _k * 2.0 - x * x * _c;
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S x = z[0], y = z[1], xx = x * x, yy = y * y;
      return (z[2] * z[2] + z[3] * z[3] - xx + yy * _w) * 0.5 + xx * xx * 0.25 + x * _t + x * yy * _k + xx * y * _c;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }

   private:
    P _t, _w, _k, _c;
  };
};

inline std::shared_ptr<const systems::System> double_well(const std::map<std::string, double>& parameters) {
  return systems::recorded<DoubleWell>(systems::bound_to(DoubleWell::info(), parameters, {}));
}

}  // namespace orbweaver::test
