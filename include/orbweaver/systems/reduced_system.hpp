#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A system that conserves, beside its energy, quantities which are linear in its coordinates (momenta, the angular
/// momentum of polar coordinates), without them (docs/mathematics.md, "Several conserved quantities"): each is held, at
/// the value of the parameter that bears its name, or at 0 where none does, and the translation of the coordinates that
/// belongs to it is divided out. Two coordinates a quantity are gone; what is left conserves the rest, and its
/// orbits are those of the whole system that close but for these translations. Families, multipliers, certificates,
/// proofs and families in a parameter, a held value among them, are those of any system.
///
/// The system itself where it conserves less than two quantities, or where `why_not_reduced` says something.
/// make_system hands systems out reduced.
[[nodiscard]] std::shared_ptr<const System> reduced(std::shared_ptr<const System> system);

/// Why `reduced` leaves a system with several conserved quantities as it is: a sentence without its end, "L is not
/// linear in the coordinates". Empty where it does not, or where there is nothing to reduce.
[[nodiscard]] std::string why_not_reduced(const System& system);

/// The system that `system` is the reduced form of; null where it is none.
[[nodiscard]] const System* whole_of(const System& system);

/// The state of a reduced system that belongs to a state of the whole one. Throws core::InputError, saying which value
/// to hold, where a quantity's value there is not the one that is held. `system` is one that has a whole.
[[nodiscard]] std::vector<double> reduced_state(const System& system, std::span<const double> whole);

/// The state of the whole system in the frame of the coordinates that are left out, which are 0 in it.
[[nodiscard]] std::vector<double> whole_state(const System& system, std::span<const double> state);

}  // namespace orbweaver::systems
