#pragma once

#include <cstddef>

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Looks whether the field vanishes at the point of row `row` of /equilibria, and whether its Jacobian there has the
/// eigenvalues of the row and no others; holds periods and stability against these, the place on the curve against the
/// row before. Pure.
void check_equilibrium(const VerifiedAtlas& atlas, std::size_t row, Findings& findings);

}  // namespace orbweaver::survey
