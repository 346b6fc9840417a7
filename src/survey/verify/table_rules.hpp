#pragma once

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// The rules of docs/file_format.md that tables alone tell: order, ranges, indices, section points in their orbits'
/// order, and dW/dE = T along conservative families. Pure.
void check_tables(const VerifiedAtlas& atlas, Findings& findings);

}  // namespace orbweaver::survey
