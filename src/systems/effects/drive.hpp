#pragma once

#include <cmath>
#include <limits>

#include "effects/composition.hpp"
#include "effects/drive_phase.hpp"

namespace orbweaver::systems {

/// A periodic force drive_amplitude cos(phase) on a mass point: on a line (`coordinates` 1, without units), or along a
/// direction in a vertical plane (2, y upwards).
template <int coordinates>
class Drive {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = true;

  static Effect info() {
    Effect effect{"drive",
                  "the force drive_amplitude cos(phase), phase' = drive_frequency",
                  {{"drive_amplitude", 0.1, 0.0, std::numeric_limits<double>::infinity(), false,
                    coordinates == 1 ? "1" : "N", "largest force"},
                   drive_frequency()}};
    if (coordinates == 1) effect.parameters.back().unit = std::string("1");
    if (coordinates == 2)
      effect.parameters.push_back(
          drive_direction("drive_direction", "direction from the vertical: 0 upwards, 90 sideways"));
    return effect;
  }

  static PhaseShift shift(const Symmetry& ideal, const Bound& bound) {
    return shift_along(coordinates == 1 ? sideways : bound["drive_direction"], ideal);
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) {
      const P amplitude = bound["drive_amplitude"] / mass_of_point<coordinates>(bound);
      if constexpr (coordinates == 1) {
        _amplitude[0] = amplitude;
      } else {
        const Direction<P> direction(bound["drive_direction"]);
        _amplitude[0] = amplitude * direction.side;
        _amplitude[1] = amplitude * direction.up;
      }
    }

    /// `out`: one a coordinate, of the state z: positions, velocities, phase.
    template <class S>
    void add_acceleration(const S* z, S* out) const {
      using std::cos;
      const S wave = cos(z[2 * coordinates]);
      for (int i = 0; i < coordinates; ++i) out[i] = out[i] + wave * _amplitude[i];
    }

   private:
    P _amplitude[coordinates];
  };
};

}  // namespace orbweaver::systems
