#pragma once

#include <memory>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::refine {

/// The isotropy of a loop, known at some phase of it, at its standard phase: there the first reversor has the shift 0.
[[nodiscard]] loop::Isotropy in_standard_phase(const systems::Structure& structure, loop::Isotropy isotropy);

/// A guess from a loop at any phase, told in the scales of `scaled`, with its `isotropy` at that phase. `plain`: the
/// same system in the units of its parameters.
[[nodiscard]] Guess guess_of(std::shared_ptr<const systems::System> plain, const systems::System& scaled,
                             const loop::Loop& loop, const loop::Isotropy& isotropy);

/// Throws core::InputError for a system that cannot be refined, as refine_orbit.
[[nodiscard]] systems::Formulas refinable_formulas(const systems::System& system);

/// The same, and for one that conserves nothing, whose orbits have no period or energy of their own choice.
[[nodiscard]] systems::Formulas conservative_formulas(const systems::System& system);

}  // namespace orbweaver::refine
