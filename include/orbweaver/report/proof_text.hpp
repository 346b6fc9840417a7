#pragma once

#include <string>
#include <vector>

#include "orbweaver/prove/proof.hpp"

namespace orbweaver::report {

/// What was proven of one orbit, in words and enclosures, in the units of its system.
[[nodiscard]] std::string to_text(const prove::Proof& proof);

/// One line a proof: family, what is held, in which radius it is the only orbit and how near the centre it is, index,
/// multiplier, stability, and the seconds that each took (as many as proofs; empty: none are shown).
[[nodiscard]] std::string proofs_table(const std::vector<prove::Proof>& proofs, const std::vector<double>& seconds);

}  // namespace orbweaver::report
