#pragma once

#include <limits>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Viscous friction of a mass point: the force -damping v. `coordinates`: 1 on a line (without units), 2 in a plane.
template <int coordinates>
class Damping {
 public:
  static constexpr bool dissipates = true;
  static constexpr bool drives = false;

  static Effect info() {
    return {"damping",
            "viscous friction: the force -damping v",
            {{"damping", 0.1, 0.0, std::numeric_limits<double>::infinity(), false, coordinates == 1 ? "1" : "kg/s",
              "friction coefficient"}}};
  }

  static PhaseShift shift(const Symmetry&, const Bound&) { return PhaseShift::any; }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _rate(bound["damping"] / mass_of_point<coordinates>(bound)) {}

    /// `out`: one a coordinate, of the state z: positions, velocities, and the phase if there is one.
    template <class S>
    void add_acceleration(const S* z, S* out) const {
      for (int i = 0; i < coordinates; ++i) out[i] = out[i] - z[coordinates + i] * _rate;
    }

   private:
    P _rate;
  };
};

}  // namespace orbweaver::systems
