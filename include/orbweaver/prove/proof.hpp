#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/systems/scales.hpp"

namespace orbweaver::prove {

/// Something was not shown, which does not say that it is false.
class NotProven : public core::NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// All real numbers between two others, written so that not a bit is lost: mantissa and exponent of its midpoint, then
/// of its radius, in hexadecimal digits (Arb's arb_dump_str).
struct Enclosure {
  std::string exact;

  /// Rounded outwards. Throw core::InputError where the text is none.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  [[nodiscard]] double radius() const;
  [[nodiscard]] bool contains(const Enclosure& other) const;
  [[nodiscard]] bool contains(const numerics::Extended& number) const;
  /// "[1.23456 +/- 1.2e-30]", which holds it, with at most so many digits.
  [[nodiscard]] std::string text(int digits = 40) const;
};

/// What is to be proven, with all that a proof starts from: nothing in it is taken on trust but the system, its
/// symmetries and its conserved quantity.
struct Statement {
  std::string family;  ///< for people, as the names of the coordinates
  std::vector<std::string> state_names;
  std::string system;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< names, and the decimal numbers that are meant
  std::vector<std::string> effects;
  systems::Scales scales;          ///< in which boxes are cubes
  std::string isotropy;            ///< at the phase of `start`
  refine::HeldValue held;          ///< what picks the orbit of its family
  std::vector<double> fractions;   ///< instants of multiple shooting, in parts of the period, but for the last
  std::vector<std::string> start;  ///< states at the first and last instant, roughly, in the scales; as Enclosure
  std::vector<std::string> end;
  std::vector<std::string> centre;  ///< the unknowns in the middle of all boxes
  int digits = 0;                   ///< that are aimed at
  long bits = 0;                    ///< of midpoints
};

/// elliptic: all multipliers but the two trivial ones on the unit circle and not +-1 over the fundamental map, which no
/// small change of the system alters. hyperbolic: one of them is larger than 1 in modulus.
enum class Stability { elliptic, hyperbolic, undecided, none };
[[nodiscard]] const char* name_of(Stability stability);

/// What was proven: in the cube of half width `radius` (in the scales) about the centre there is exactly one solution
/// of the equations; it is a periodic orbit with the period, and all of its numbers lie in their enclosures, told in
/// the units of the system.
struct Proof {
  Statement statement;
  std::string isolated_by;  ///< which equations pick it
  double radius = 0.0;
  double distance = 0.0;         ///< the solution is at most so far from the centre
  std::vector<Enclosure> state;  ///< at t = 0
  Enclosure period;
  Enclosure energy;
  int order = 1;                               ///< p of the fundamental map
  std::optional<Enclosure> fundamental_index;  ///< mu + 1/mu of the fundamental map; none in the plane
  std::optional<Enclosure> index;              ///< of the full period
  Stability stability = Stability::none;
  /// Of the full period, unless undecided: real and imaginary part of the one above the real axis, or the larger one.
  std::vector<Enclosure> multiplier;
  int taylor_order = 0;
  long steps = 0;  ///< of all validated integrations
};

inline constexpr int most_proof_digits = 300;

/// The orbit near the guess whose period or energy is the held one, as a statement about the system in its units: its
/// centre is refined to `digits` and some more. `effects`: those that the system was asked for. Throws as
/// refine_orbit, and NotProven.
[[nodiscard]] Statement statement_about(const std::string& family, const std::vector<std::string>& effects,
                                        const refine::Guess& guess, const refine::HeldValue& held, int digits);

/// The same of an orbit of an archive: "T=9", "E=-0.5" or a step of the family (refine::StoredFamily::named_orbit).
[[nodiscard]] Statement statement_about(const archive::Archive& atlas, const std::string& family,
                                        const std::string& orbit, int digits);

/// Encloses the orbit (docs/mathematics.md, "Proofs"). Without `radius`: the largest of a few in which there is one
/// orbit. Throws NotProven where nothing can be shown, core::InputError for a statement that makes no sense.
[[nodiscard]] Proof prove(const Statement& statement, std::optional<double> radius = std::nullopt);

/// Proves it again from its statement and radius alone. Returns what of `proof` does not follow, one sentence each.
[[nodiscard]] std::vector<std::string> check(const Proof& proof);

}  // namespace orbweaver::prove
