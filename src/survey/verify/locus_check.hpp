#pragma once

#include <cstddef>

#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Integrates the orbit of row `row` of /loci from its state, converges it anew by Newton's method on its closure, and
/// looks whether its linearised flow has what its kind claims. Sees nothing of loops and their solvers. Pure.
void check_locus_point(const VerifiedAtlas& atlas, std::size_t row, Findings& findings);

}  // namespace orbweaver::survey
