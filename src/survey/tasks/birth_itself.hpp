#pragma once

#include "orbweaver/continuation/family_curve.hpp"
#include "tasks/payload/locate_work.hpp"

namespace orbweaver::survey {

/// Whether T or the energy turns, or an index passes 2, where a family is born, and nowhere else: its orbits are even
/// in their distance from the birth (but for a family that goes through it), and where two births lie side by side to
/// rounding, their crossing lies between them. `position`: of the event, on the curve of `work.known`.
[[nodiscard]] bool is_birth_itself(const LocateWork& work, continuation::FamilyCurve& family, double position);

}  // namespace orbweaver::survey
