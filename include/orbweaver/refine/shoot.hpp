#pragma once

#include <vector>

#include "orbweaver/refine/orbit.hpp"

namespace orbweaver::refine {

/// An orbit by shooting in double precision, in the units of the system: its states at a few instants, t/T increasing
/// from 0 on (standard phase).
struct ShotOrbit {
  std::vector<double> fractions;
  std::vector<std::vector<double>> states;
  double period = 0.0;
};

/// Newton's method in double precision on `segments` segments of the fundamental domain: 1 is single shooting, 0 as
/// many as refine_orbit begins with. Throws InputError as refine_orbit, NumericalError where Newton's method finds no
/// orbit, MisuseError for more segments than those.
[[nodiscard]] ShotOrbit shoot(const Guess& guess, const HeldValue& held, int segments);

/// The states of a refined orbit, rounded to double, at instants t/T that increase, integrated with all of its digits.
[[nodiscard]] std::vector<std::vector<double>> states_of(const Guess& guess, const RefinedOrbit& orbit,
                                                         const std::vector<double>& fractions);

}  // namespace orbweaver::refine
