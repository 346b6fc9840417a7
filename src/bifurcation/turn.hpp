#pragma once

#include <optional>

#include "event_function.hpp"

namespace orbweaver::bifurcation {

/// Where a period, an energy or a parameter turns. Directions along the family may be uncertain: then its extremum is
/// looked for. That is known to half the digits only, and the slope's root beside it is taken if it is as extreme. None
/// where it turns so little that rounding may make it: `why` then says so.
[[nodiscard]] std::optional<numerics::Located> turn(const systems::System& system, continuation::FamilyCurve& family,
                                                    const Event& event, EventFunction& slope_at, const Interval& within,
                                                    double tolerance, NotLocated& why);

}  // namespace orbweaver::bifurcation
