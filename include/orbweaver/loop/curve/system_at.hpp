#pragma once

#include <memory>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::loop {

/// The system with the parameter values of a loop; `system` itself, which must outlive the result, where it has them
/// already. Everything that evaluates a system on a loop asks for it. Throws MisuseError for a loop with another number
/// of values than the system has parameters that move.
[[nodiscard]] std::shared_ptr<const systems::System> system_at(const systems::System& system, const Loop& loop);

}  // namespace orbweaver::loop
