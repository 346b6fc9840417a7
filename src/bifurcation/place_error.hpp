#pragma once

#include "event_function.hpp"
#include "orbweaver/bifurcation/place_error.hpp"

namespace orbweaver::bifurcation {

/// Of a fold that was located at `place`: by its slope's scatter there; where that does not tell, by what turns.
[[nodiscard]] Enclosure enclosure_of_fold(EventFunction& slope, double place, const Interval& within, double least);

/// What an enclosure along the family means for its orbits, by those that the function was asked at. `there`: of the
/// orbit at the place.
[[nodiscard]] PlaceError place_error(const EventFunction& function, const continuation::FamilyCurve& family,
                                     double place, const EventFunction::Levels& there, const Enclosure& enclosure);

}  // namespace orbweaver::bifurcation
