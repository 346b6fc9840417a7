#pragma once

#include <cmath>
#include <limits>

#include "effects/composition.hpp"
#include "effects/drive_phase.hpp"

namespace orbweaver::systems {

/// Motors at both joints of the double pendulum, with the torques constant1 + amplitude1 cos(phase) at the pivot and
/// constant2 + amplitude2 cos(phase) between the rods.
class JointTorque {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = true;

  static Effect info() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {"joint_torque",
            "torques torque1 + torque1_amplitude cos(phase) at the pivot and torque2 + torque2_amplitude cos(phase) "
            "between the rods, phase' = drive_frequency",
            {{"torque1", 0.0, -inf, inf, false, "N m", "constant torque at the pivot"},
             {"torque1_amplitude", 0.1, 0.0, inf, false, "N m", "periodic torque at the pivot"},
             {"torque2", 0.0, -inf, inf, false, "N m", "constant torque between the rods"},
             {"torque2_amplitude", 0.0, -inf, inf, false, "N m", "periodic torque between the rods"},
             drive_frequency()}};
  }

  static PhaseShift shift(const Symmetry& ideal, const Bound& bound) {
    if (!mirrors(ideal)) return PhaseShift::none;
    return bound["torque1"] == 0.0 && bound["torque2"] == 0.0 ? PhaseShift::half_turn : PhaseShift::broken;
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _constant1(bound["torque1"]),
          _amplitude1(bound["torque1_amplitude"]),
          _constant2(bound["torque2"]),
          _amplitude2(bound["torque2_amplitude"]) {}

    template <class S>
    void add_torques(const S* z, S& on_1, S& on_2) const {
      using std::cos;
      const S wave = cos(z[4]);
      const S between = wave * _amplitude2 + _constant2;
      on_1 = on_1 + wave * _amplitude1 + _constant1 - between;
      on_2 = on_2 + between;
    }

   private:
    P _constant1;
    P _amplitude1;
    P _constant2;
    P _amplitude2;
  };
};

}  // namespace orbweaver::systems
