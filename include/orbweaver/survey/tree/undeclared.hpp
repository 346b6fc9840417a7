#pragma once

#include <span>
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

/// Of a trajectory that closes: in how many directions its neighbours close too, after a time that may differ, beyond
/// those along the orbit and one for each quantity that the structure names; to first order, so that orbits of folds
/// and branch points have such directions as well. 0 where orbits are isolated. `tolerance`: of the integration.
/// Throws NumericalError where the trajectory cannot be integrated.
[[nodiscard]] int undeclared_directions(const systems::System& system, std::span<const double> state, double period,
                                        double tolerance);

}  // namespace orbweaver::survey
