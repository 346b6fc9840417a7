#pragma once

#include <cstddef>

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Converges the orbit at row `crossing` of /crossings anew from the orbits beside it, holds the row against it, and
/// looks whether the families that were born there begin there, and those that end there come to it. Pure.
void check_crossing(const VerifiedAtlas& atlas, std::size_t crossing, Findings& findings);

}  // namespace orbweaver::survey
