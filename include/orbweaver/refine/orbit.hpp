#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::refine {

/// An orbit that is roughly known, and its family.
struct Guess {
  /// In the units of its parameters, and the scales in which distances count.
  std::shared_ptr<const systems::System> system;
  systems::Scales scales;
  loop::Loop loop;          ///< in units, in standard phase
  loop::Isotropy isotropy;  ///< the family's, at that phase
};

/// What picks one orbit of a family: a period or energy, or the parameter along whose values the family runs, as a
/// decimal number in the units of the system, that is taken to be exact. The system of a guess has that value already;
/// it alone picks the orbit where nothing is conserved.
struct HeldValue {
  enum class Quantity { period, energy, parameter } quantity;
  std::string decimal;
};

/// What holds exactly at a crossing: the multiplier e^(2 pi i j/q) of the fundamental map, or dT/ds = 0, or dE/ds = 0.
struct CrossingCondition {
  archive::CrossingKind kind;
  int sector_j = 0;
  int sector_q = 1;
};

/// A number with a bound on its error.
struct Number {
  numerics::Extended value;
  numerics::Extended error;  ///< 0: exact
};

/// A real number, or that of a conjugate pair which lies above the real axis.
struct ComplexNumber {
  Number real;
  std::optional<Number> imaginary;
};

/// An orbit to many digits, in the units of the system. All of its numbers hold to `digits` significant digits (of
/// 1e-9 of their scale, where they are smaller than that).
struct RefinedOrbit {
  std::vector<Number> state;  ///< at t = 0, in standard phase
  Number period;
  std::optional<Number> energy;             ///< where one is conserved
  int order = 1;                            ///< p of the fundamental map
  std::optional<Number> index;              ///< mu + 1/mu of the full period; none in the plane
  std::optional<Number> fundamental_index;  ///< the same of the fundamental map
  std::string reversor;  ///< on whose fixed set t = 0 lies; empty: none, and without `largest` the drive's phase is 0
  std::optional<std::size_t> largest;  ///< then the coordinate that is largest at t = 0
  /// Of the full period, where the index is not +-2: mu > 1/mu in modulus, real; or the real and imaginary part of the
  /// one above the real axis.
  std::vector<Number> multipliers;
  bool unit_circle = false;  ///< the latter
  /// Where nothing is conserved: all but the trivial one, the largest modulus first, to `digits` digits of 1.
  std::vector<ComplexNumber> spectrum;
  std::optional<Number> test_value;  ///< at a crossing: what is left of the condition
  int digits = 0;
  int working_digits = 0;  ///< of the last computation
  int taylor_order = 0;
  long steps = 0;    ///< of all integrations
  int segments = 0;  ///< of multiple shooting
};

/// The orbit near the guess whose period or energy is the held one.
///
/// Multiple shooting on the fundamental domain with Taylor series (taylor/flow.hpp), first in double, then in extended
/// arithmetic with the factors of the Jacobian in double: each iteration gains as many digits as those are good for.
/// It is computed twice, the second time with more digits, a higher order and so other steps; the bounds on errors are
/// twice the differences of the two, plus the rounding of the first.
///
/// Throws core::InputError for a system that cannot be refined (no formulas, a conserved energy and more than one
/// pair of multipliers, a parameter without a value of its own), a quantity that does not fit it, or digits outside [1,
/// most_digits]; core::NumericalError where no orbit is found, or one that the condition does not isolate (a fold in
/// the period at a held period).
[[nodiscard]] RefinedOrbit refine_orbit(const Guess& guess, const HeldValue& held, int digits);

/// The orbit near the guess at which the condition holds, of a system with a conserved energy. `towards`: another orbit
/// of the family near by, in phase with the guess. Throws as refine_orbit, InputError for kinds that have no condition
/// here (torus, krein) or no sector.
[[nodiscard]] RefinedOrbit refine_crossing(const Guess& guess, const CrossingCondition& condition, int digits);

inline constexpr int most_digits = 1000;

/// The better of the two for an orbit of the family at the guess: the period, unless that is nearly at an extremum.
[[nodiscard]] HeldValue::Quantity better_held(const Guess& guess);

}  // namespace orbweaver::refine
