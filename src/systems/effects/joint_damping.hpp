#pragma once

#include <limits>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Viscous friction at both joints of the double pendulum; Rayleigh's function is c1 w1^2/2 + c2 (w2 - w1)^2/2.
class JointDamping {
 public:
  static constexpr bool dissipates = true;
  static constexpr bool drives = false;

  static Effect info() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {"damping",
            "viscous friction at both joints: torques -c1 w1 and -c2 (w2 - w1)",
            {{"c1", 0.1, 0.0, inf, false, "N m s/rad", "friction at the pivot"},
             {"c2", 0.1, 0.0, inf, false, "N m s/rad", "friction between the rods"}}};
  }

  static PhaseShift shift(const Symmetry&, const Bound&) { return PhaseShift::any; }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _c1(bound["c1"]), _c2(bound["c2"]) {}

    template <class S>
    void add_torques(const S* z, S& on_1, S& on_2) const {
      const S between = (z[3] - z[2]) * _c2;
      on_1 = on_1 - z[2] * _c1 + between;
      on_2 = on_2 - between;
    }

   private:
    P _c1;
    P _c2;
  };
};

}  // namespace orbweaver::systems
