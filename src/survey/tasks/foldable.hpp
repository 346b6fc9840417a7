#pragma once

#include <vector>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What of a family's orbits may fold: T and E, T alone where no energy is kept, or the parameter that moves.
[[nodiscard]] std::vector<bifurcation::Fold::Quantity> foldable(const systems::System& system);

[[nodiscard]] double value_of(const systems::System& system, bifurcation::Fold::Quantity quantity,
                              const loop::Loop& loop);

/// Of the value along the family, at a place with a tangent.
[[nodiscard]] double slope_of(const systems::System& system, bifurcation::Fold::Quantity quantity,
                              const continuation::CurvePoint& point);

/// The least change of a quantity that tells a fold, where its value is `value`.
[[nodiscard]] double visible_change(bifurcation::Fold::Quantity quantity, double value);

/// How far rounding may move the quantity at an orbit, which it leaves open across the family. As much of its slope
/// along the family may be that of another one.
[[nodiscard]] double moved_by_rounding(const systems::System& system, const loop::Isotropy& isotropy,
                                       bifurcation::Fold::Quantity quantity, const loop::Loop& orbit);

/// The same where it is known how far `open` the orbit is left (continuation/left_open.hpp).
[[nodiscard]] double moved_by(const systems::System& system, bifurcation::Fold::Quantity quantity,
                              const loop::Loop& orbit, double open);

}  // namespace orbweaver::survey
