#pragma once

#include <memory>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// The mean of a driven field over `phases` equal phases of its drive, a power of two: opposite phases are added first,
/// so that what goes with the cosine cancels. It changes nothing where the drive is at zero, rests where the drive
/// pushes around, and the driven system itself may not. Throws MisuseError for a system without a drive.
[[nodiscard]] std::shared_ptr<const System> averaged_over_drive(const std::shared_ptr<const System>& system,
                                                                int phases);

}  // namespace orbweaver::systems
