#pragma once

#include <cstddef>

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Looks whether the families that were born at the crossing of this row begin there, and those that end there come to
/// it. `orbit`: the one at the crossing.
void check_families_at(const VerifiedAtlas& atlas, std::size_t row, const loop::Loop& orbit, Findings& findings);

}  // namespace orbweaver::survey
