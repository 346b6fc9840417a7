#pragma once

#include <optional>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::survey {

/// Stability indices of multipliers on the unit circle are no further apart: one that is known no better is not known.
inline constexpr double values_on_circle = 4.0;

/// The archive's `stability_error`: the largest error bound of the full period's indices, or multipliers; those beyond
/// double precision have none. NaN where no index is in its range.
[[nodiscard]] double stability_error(const spectrum::Stability& stability);

/// Fills the row's stability columns; NaN where the multipliers could not be computed.
void set_stability(const systems::Structure& system, const std::optional<spectrum::Stability>& stability,
                   archive::OrbitRecord& row);

}  // namespace orbweaver::survey
