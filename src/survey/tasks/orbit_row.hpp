#pragma once

#include <optional>
#include <string>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Multipliers of an orbit, or none where they cannot be computed. `team` divides the work; may be null.
[[nodiscard]] std::optional<spectrum::Stability> stability_of(const systems::System& system, const loop::Loop& loop,
                                                              const loop::Isotropy& isotropy,
                                                              core::Team* team = nullptr);

/// The row's log_volume: NaN where the field's derivatives are not finite.
[[nodiscard]] double log_volume_of(const systems::System& system, const loop::Loop& loop);

/// Why rounding does not tell an orbit from others near it, as the beginning of a sentence; empty where it does, or
/// where that is not known. `neighbour`: one on its family; may be null.
[[nodiscard]] std::string not_told_apart(const systems::System& system, const loop::Loop& orbit,
                                         const loop::Loop* neighbour, const loop::Isotropy& isotropy, core::Team* team);

/// The same where rounding leaves the orbit open by more than its neighbour is away.
[[nodiscard]] std::string nearer_than_rounding(const systems::System& system, const loop::Loop& orbit,
                                               const loop::Loop& neighbour, const loop::Isotropy& isotropy);

/// The row of an accepted orbit, with its certificate if `certifier` is given. `stored`: its loop in standard phase
/// (loop::in_standard_phase).
[[nodiscard]] archive::OrbitRecord orbit_row(const systems::System& system, const std::string& family,
                                             const continuation::Orbit& orbit, const loop::Loop& stored,
                                             const std::optional<spectrum::Stability>& stability,
                                             certificate::Certifier* certifier);

}  // namespace orbweaver::survey
