#pragma once

#include <cstddef>

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Computes rows [first, end) of /orbits, all of one family, again from their modes, and the way to each from the orbit
/// before it. Pure.
void check_orbits(const VerifiedAtlas& atlas, std::size_t first, std::size_t end, Findings& findings);

}  // namespace orbweaver::survey
