#pragma once

#include <limits>

#include "effects/composition.hpp"
#include "effects/drive_phase.hpp"

namespace orbweaver::systems {

/// The double pendulum's pivot is shaken: it stands at pivot_amplitude cos(phase) (m) along a direction in the
/// pendulum's plane. In the frame that goes with it the bobs feel the acceleration
///   pivot_amplitude drive_frequency^2 cos(phase)
/// along that direction, beside gravity.
class PivotDrive {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = true;

  static Effect info() {
    return {"pivot_drive",
            "the pivot shaken by pivot_amplitude cos(phase) along pivot_direction, phase' = drive_frequency",
            {{"pivot_amplitude", 0.1, 0.0, std::numeric_limits<double>::infinity(), false, "m", "how far it is shaken"},
             drive_direction("pivot_direction", "direction from the vertical: 0 upwards, 90 sideways"),
             drive_frequency()}};
  }

  static PhaseShift shift(const Symmetry& ideal, const Bound& bound) {
    return shift_along(bound["pivot_direction"], ideal);
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) {
      const P& frequency = bound["drive_frequency"];
      const P most = bound["pivot_amplitude"] * frequency * frequency;
      const Direction<P> direction(bound["pivot_direction"]);
      _side = most * direction.side;
      _up = most * direction.up;
    }

    /// The acceleration felt, beside gravity.
    template <class S>
    void set_felt(const S& phase, S& side, S& up) const {
      using std::cos;
      const S wave = cos(phase);
      side = wave * _side;
      up = wave * _up;
    }

   private:
    P _side;
    P _up;
  };
};

}  // namespace orbweaver::systems
