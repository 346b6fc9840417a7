#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Of all drives of a system: they share one phase, with phase' = drive_frequency, and go with its cosine.
inline Parameter drive_frequency() {
  return {"drive_frequency",
          1.0,
          0.0,
          std::numeric_limits<double>::infinity(),
          true,
          "rad/s",
          "angular frequency of the drive"};
}

/// Directions in a vertical plane, in degrees from the vertical; the opposite one is half a turn of the phase.
inline Parameter drive_direction(const char* name, const char* meaning) {
  return {name, 0.0, -90.0, 90.0, true, "deg", meaning};
}

constexpr double upright = 0.0;    ///< degrees
constexpr double sideways = 90.0;  ///< degrees

/// What the mirror image to the side needs of the phase, if the drive acts along `degrees`.
inline PhaseShift shift_along(double degrees, const Symmetry& ideal) {
  if (!mirrors(ideal) || degrees == upright) return PhaseShift::none;
  return degrees == sideways ? PhaseShift::half_turn : PhaseShift::broken;
}

/// The unit vector along `degrees` from the vertical; its components are 0 and 1 exactly along and across it.
template <class P>
struct Direction {
  P side;
  P up;

  explicit Direction(const P& degrees) : side(sine(degrees)), up(sine(sideways - degrees)) {}

 private:
  static P sine(const P& degrees) {
    using std::sin;
    return sin(degrees * (std::numbers::pi / 180.0));
  }
};

}  // namespace orbweaver::systems
