#pragma once

#include <cstddef>

#include "orbweaver/continuation/family_curve.hpp"
#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Holds what a crossing's row says of the error of its place: so far to both sides of `position` on the curve through
/// orbits beside it, what vanishes there exceeds its own error, and period, energy and parameter change by no more than
/// is said. An error of a place that is too small is found, one that is too large is not.
void check_place_error(const VerifiedAtlas& atlas, std::size_t crossing, continuation::FamilyCurve& curve,
                       double position, Claims& claims);

}  // namespace orbweaver::survey
