#pragma once

#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// What a system's functions cost on this machine, in ns a node.
struct FieldCost {
  double field = 0.0;
  double field_and_jacobian = 0.0;
};

/// Measured on some hundred states around `point` (size dimension), the best of many repetitions: some ms each.
[[nodiscard]] FieldCost field_cost(const System& system, const std::vector<double>& point);

}  // namespace orbweaver::systems
