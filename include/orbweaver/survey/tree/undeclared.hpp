#pragma once

#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What the field of a system has and its structure does not name.
struct Undeclared {
  std::vector<std::string> symmetries;  ///< as text (systems::undeclared_symmetries)
  std::vector<std::string> translated;  ///< coordinates, with a momentum (systems::undeclared_translations)
  std::vector<std::string> turned;      ///< coordinates, with an angular momentum (systems::undeclared_turns)
  bool may_be_symplectic = false;       ///< systems::may_be_symplectic, at equilibria alone
};

/// In the survey's scales (ScaledScene), as its numbers tell only there what is large. Looked for about the equilibria
/// or, where there are none, about the origin and the states that the scene gives.
[[nodiscard]] Undeclared undeclared(const systems::System& system, const std::vector<std::vector<double>>& equilibria,
                                    const std::vector<std::vector<double>>& states);

}  // namespace orbweaver::survey
