#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/systems/linear_totals.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A system that conserves, beside its energy, quantities which are linear in its coordinates (momenta, the angular
/// momentum of polar coordinates), without them (docs/mathematics.md, "Several conserved quantities"): each is held, at
/// the value of the parameter that bears its name, or at 0 where none does, and the translation of the coordinates that
/// belongs to it is divided out. Two coordinates a quantity are gone; what is left conserves the rest, and its
/// orbits are those of the whole system that close but for these translations. Families, multipliers, certificates,
/// proofs and families in a parameter, a held value among them, are those of any system.
///
/// One that is dissipative, or names nothing that it conserves, comes without its linear totals: `without_totals` with
/// all of them 0 unless a parameter says otherwise.
///
/// The system itself where it conserves less than two quantities and has no totals, or where `why_not_reduced` says
/// something. make_system hands systems out reduced.
[[nodiscard]] std::shared_ptr<const System> reduced(std::shared_ptr<const System> system);

/// What totals are held at, and what moves. Of make_system's parameters those named after totals are values, and those
/// named after all coordinates the place.
struct HeldTotals {
  std::map<std::string, double> values;  ///< by name
  /// A state of the whole system, or nothing (the origin): totals without a value have that which they have there, and
  /// the coordinates that then follow from the others are large there.
  std::vector<double> place;
  FamilyScalars moving;  ///< along the families; it may name totals
};

/// The system without its totals (linear_totals): one coordinate a total follows from the others, and its value is a
/// parameter of its name like any other.
[[nodiscard]] std::shared_ptr<const System> without_totals(std::shared_ptr<const System> system,
                                                           const std::vector<LinearTotal>& totals,
                                                           const HeldTotals& held);

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
