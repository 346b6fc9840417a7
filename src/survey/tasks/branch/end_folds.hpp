#pragma once

#include <optional>
#include <vector>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Places of a family on the way to one of its ends, which may be a crossing where another family goes on.
struct WayToEnd {
  std::optional<continuation::FamilyCurve::Known> inner;  ///< the stored orbit before the first of `points`
  std::vector<continuation::CurvePoint> points;           ///< with tangents, nearer to the end one after the other
  std::optional<loop::Loop> crossing;                     ///< the orbit there, or the nearest to it; none where none is
  bool goes_through = false;  ///< the crossing, at any slope: slopes on a line tell what values leave open
};

/// The folds on the way that differences of stored orbits do not show: where the slopes of T and E (or of the parameter
/// that moves) at two neighbouring places have opposite signs, or the first one's and the difference to `inner`.
[[nodiscard]] std::vector<bifurcation::Fold> folds_on(const systems::System& system, const loop::Isotropy& isotropy,
                                                      const WayToEnd& way);

/// Of folds between `inner` and the first of `points`, told by the slopes there, those that places nearer to the end
/// bear out. Beside a crossing a tangent may hold a part of the other family's.
[[nodiscard]] std::vector<bifurcation::Fold> borne_out(const systems::System& system, const loop::Isotropy& isotropy,
                                                       std::vector<bifurcation::Fold> folds, const WayToEnd& way);

/// The slopes of what may fold, at a place with a tangent.
[[nodiscard]] bifurcation::FoldWatch::Slopes slopes_at(const systems::System& system,
                                                       const continuation::CurvePoint& point);

}  // namespace orbweaver::survey
