#include "orbweaver/survey/tree/undeclared.hpp"

#include <cstddef>

#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/undeclared_symmetries.hpp"
#include "orbweaver/systems/undeclared_turns.hpp"

namespace orbweaver::survey {

Undeclared undeclared(const systems::System& system, const std::vector<std::vector<double>>& equilibria,
                      const std::vector<std::vector<double>>& states) {
  std::vector<std::vector<double>> centres = equilibria;
  if (centres.empty()) {
    centres.emplace_back(static_cast<std::size_t>(system.dimension()), 0.0);
    centres.insert(centres.end(), states.begin(), states.end());
  }
  return {systems::undeclared_symmetries(system, centres), systems::undeclared_translations(system),
          systems::undeclared_turns(system, centres), systems::may_be_symplectic(system, equilibria)};
}

}  // namespace orbweaver::survey
