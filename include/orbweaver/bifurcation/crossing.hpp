#pragma once

#include <memory>
#include <optional>
#include <string>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/bifurcation/place_error.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// What is to be located: a zero of a test function, or an extremum of the period, the energy or the parameter.
struct Event {
  enum class Kind { test_function, fold_period, fold_energy, fold_parameter };
  [[nodiscard]] friend constexpr Kind last_of(Kind) { return Kind::fold_parameter; }
  Kind kind = Kind::test_function;
  TestFunction function{};  ///< of Kind::test_function
  bool tangency = false;    ///< the function only touches zero
  /// A tangency at which a multiplier passes 1 or -1 and stays on the unit circle, to rounding: there
  /// `Stability::twist` changes its sign, by which it is located.
  bool passed = false;
  /// It is looked for from the orbit on which the family is born (`tell_birth`).
  bool from_birth = false;
  /// One of two crossings (`parted_crossings`), whose function is `determinant_deviation`.
  bool is_parted = false;
  /// Two indices that a symmetry makes equal pass together, so that the function touches zero only: the root of
  /// `index_deviation` is located.
  bool is_double = false;

  static constexpr int wire_version = 5;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, kind, function, tangency, passed, from_birth, is_parted, is_double);
  }
};

/// A located event.
struct Crossing {
  continuation::CurvePoint point;  ///< the orbit there, with the family's direction
  spectrum::Stability stability;
  Reading reading{};   ///< of the test function, or of the slope of what folds along the family
  double width = 0.0;  ///< of the interval of positions that is left around it
  PlaceError place_error;
};

/// Why an event was not located.
struct NotLocated {
  enum class Reason {
    no_zero,         ///< the function does not change sign between `from` and `to`, where it is `at_from` and `at_to`
    no_orbit,        ///< none converges at `position`
    no_multipliers,  ///< those of the orbit at `position` cannot be computed; `detail` says why
    no_value,        ///< the function of these multipliers is not a number at `position`
    no_crossing,     ///< the sign changes by a jump: the function is `at_from` at `position`, its error bound `at_to`
    no_event,        ///< the function vanishes at `position` for another reason than the event that it stands for
    unclear_event,   ///< whether it does so is within the error bounds of the multipliers at `position`
    unclear_fold,    ///< what turns does so by `at_from` at `position`, where rounding scatters it by `at_to`
  };
  Reason reason = Reason::no_zero;
  double from = 0.0;
  double to = 0.0;
  double at_from = 0.0;
  double at_to = 0.0;
  double position = 0.0;
  double period = 0.0;  ///< of the orbit at `position`; without one, of the known orbit before it
  std::string detail{};
};
[[nodiscard]] std::string to_text(const NotLocated& why);

/// Locates `event` between two positions of the family, every trial orbit converged anew. Positions are found to
/// `tolerance` relative to 1 + |position|, to 1e-10 at least, since indices are to be right to |dk/ds| 1e-10
/// (docs/mathematics.md, "Location"). None where the function has no zero there, or changes its
/// sign by a jump (`why` then says so).
[[nodiscard]] std::optional<Crossing> locate(const systems::System& system, continuation::FamilyCurve& family,
                                             const Event& event, double from, double to, NotLocated& why,
                                             double tolerance = 1e-11);

/// Test functions of a family's birth that are smaller vanish there, the family's own for one, and at orbits beside it
/// say nothing where rounding leaves those open: that goes away from zero like a power of the distance. Their error
/// bounds do not tell: they take a Newton step, and the orbits of two families lie side by side. The crossing is
/// located to 1e-9.
inline constexpr double zero_at_birth = 1e-6;

/// Of the orbit on which a family is born, in the family's symmetries: an index is 2, which computed it may miss by any
/// amount where indices are of 1e13 beside it. The others' values tell: their error bounds are those of a place where
/// orbits are not isolated.
void tell_birth(const systems::Structure& system, spectrum::Stability& birth);

/// The multiplier pair that is nearest to the sector: k - 2 cos(2 pi j/q), with its error bound; of a system that is
/// not symplectic the nontrivial multiplier, mu - cos(2 pi j/q).
[[nodiscard]] Reading index_deviation(const systems::Structure& system, const spectrum::Stability& stability,
                                      const Sector& sector);

}  // namespace orbweaver::bifurcation
