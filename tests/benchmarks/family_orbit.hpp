#pragma once

#include <memory>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::benchmarks {

/// The families of the ideal double pendulum, by the equilibrium and the place among its modes, longest period first.
enum class Family { in_phase, out_phase, down_up, up_down };

struct FamilyStart {
  std::shared_ptr<const systems::System> system;
  continuation::Start start;
};
[[nodiscard]] FamilyStart start_of(Family family);

/// The family's orbit with exactly this period (its own cutoff), and its isotropy; kept for the process.
struct FamilyOrbit {
  std::shared_ptr<const systems::System> system;
  loop::Loop loop;
  loop::Isotropy isotropy;
};
[[nodiscard]] const FamilyOrbit& family_orbit(Family family, double period);

}  // namespace orbweaver::benchmarks
