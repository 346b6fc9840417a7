#pragma once

#include <memory>
#include <vector>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Folds in pairs between neighbours of a family's known orbits, from each of which to the next T or E (or the
/// parameter that moves) rises, or falls, all the same: slopes are looked at where it does so slower on the way from
/// the orbit `way` to the next than on the ways beside it, of which there must be one.
[[nodiscard]] std::vector<bifurcation::Fold> paired_folds(const std::shared_ptr<const systems::System>& system,
                                                          const loop::Isotropy& isotropy,
                                                          const continuation::Options& options,
                                                          const std::vector<continuation::FamilyCurve::Known>& known,
                                                          std::size_t way);

}  // namespace orbweaver::survey
