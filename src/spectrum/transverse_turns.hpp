#pragma once

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "transverse_flow.hpp"

namespace orbweaver::spectrum {

/// As Stability::turns, of a system with four dimensions, a conserved energy and one pair of multipliers whose index is
/// `index` and whose twist is `twist`. NaN where the chain's segments are too long to tell.
[[nodiscard]] double transverse_turns(const Chain& chain, const TransverseFlow& flow, const FundamentalGroup& group,
                                      double index, double twist);

}  // namespace orbweaver::spectrum
