#pragma once

#include <vector>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/left_open.hpp"
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

/// How much of the quantity's slope along the family at an orbit may be that of another one, where rounding leaves the
/// orbit open across the family.
[[nodiscard]] double slope_left_open(const systems::System& system, const loop::Isotropy& isotropy,
                                     bifurcation::Fold::Quantity quantity, const loop::Loop& orbit);

/// How far rounding may move the quantity at an orbit that it leaves so much `open`.
[[nodiscard]] double moved_by_rounding(const systems::System& system, bifurcation::Fold::Quantity quantity,
                                       const loop::Loop& orbit, const continuation::LeftOpen& open);
[[nodiscard]] double moved_by_rounding(const systems::System& system, const loop::Isotropy& isotropy,
                                       bifurcation::Fold::Quantity quantity, const loop::Loop& orbit);

/// Whether rounding may have made the change from `turn` to `orbit` where it would tell which way the quantity goes:
/// the first change of a family, and one against the last. `known`: orbits before, that of the turn perhaps among them.
[[nodiscard]] bool is_rounding(const systems::System& system, const loop::Isotropy& isotropy,
                               bifurcation::Fold::Quantity quantity, const bifurcation::FoldWatch::Turn& turn,
                               const loop::Loop& orbit, const std::vector<continuation::FamilyCurve::Known>& known);

}  // namespace orbweaver::survey
