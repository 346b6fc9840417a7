#pragma once

#include <algorithm>
#include <limits>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Torsion springs at both joints of the double pendulum, stiffness spring1, spring2 (N m/rad), at rest where
/// th1 = rest1 and th2 - th1 = rest2:
///   potential energy  spring1 (th1 - rest1)^2/2 + spring2 (th2 - th1 - rest2)^2/2.
/// A turn winds them up, so that th1 and th2 are no angles.
class TorsionSprings {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = false;

  static Effect info() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {"torsion_springs",
            "torsion springs at both joints: torques -spring1 (th1 - rest1) and -spring2 (th2 - th1 - rest2)",
            {{"spring1", 1.0, 0.0, inf, false, "N m/rad", "stiffness at the pivot"},
             {"spring2", 1.0, 0.0, inf, false, "N m/rad", "stiffness between the rods"},
             {"rest1", 0.0, -inf, inf, false, "rad", "th1 where the first spring is at rest"},
             {"rest2", 0.0, -inf, inf, false, "rad", "th2 - th1 where the second spring is at rest"}}};
  }

  static PhaseShift shift(const Symmetry& ideal, const Bound& bound) {
    const bool straight = bound["rest1"] == 0.0 && bound["rest2"] == 0.0;
    return mirrors(ideal) && !straight ? PhaseShift::broken : PhaseShift::any;
  }

  static void change(Structure& structure) {
    std::erase_if(structure.angles, [](int angle) { return angle < 2; });
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _spring1(bound["spring1"]), _spring2(bound["spring2"]), _rest1(bound["rest1"]), _rest2(bound["rest2"]) {}

    template <class S>
    void add_torques(const S* z, S& on_1, S& on_2) const {
      const S between = (z[1] - z[0] - _rest2) * _spring2;
      on_1 = on_1 - (z[0] - _rest1) * _spring1 + between;
      on_2 = on_2 - between;
    }

    template <class S>
    S potential(const S* z) const {
      const S first = z[0] - _rest1;
      const S second = z[1] - z[0] - _rest2;
      return (first * first * _spring1 + second * second * _spring2) * 0.5;
    }

   private:
    P _spring1;
    P _spring2;
    P _rest1;
    P _rest2;
  };
};

}  // namespace orbweaver::systems
