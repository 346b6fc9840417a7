#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "orbweaver/bifurcation/outside_circle.hpp"
#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::bifurcation {

/// Of its bound, the error that a multiplier, an index or a function of them may have: bounds are estimates, good to a
/// factor.
inline constexpr double error_margin = 10.0;

/// A number and a bound on its absolute error.
struct Reading {
  double value;
  double error;

  /// -1 or 1, or 0 where the value does not exceed its error bound or either is not a number.
  [[nodiscard]] int sign() const;
  /// As `sign`, and 0 too within `error_margin` of the bound.
  [[nodiscard]] int clear_sign() const;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, value, error);
  }
};

/// A continuous function along a family, within [-1, 1], that changes sign where another family may cross.
struct TestFunction {
  /// What each does is a file in src/bifurcation/test_functions.
  enum class Kind {
    sector,  ///< a multiplier passes exp(+-2 pi i j/q)
    krein,   ///< two pairs of multipliers meet and leave the unit circle, or come back to it (symplectic)
    torus,   ///< a complex pair passes the unit circle (dissipative)
  };
  [[nodiscard]] friend constexpr Kind last_of(Kind) { return Kind::torus; }
  Kind kind = Kind::sector;
  Sector sector{};  ///< of Kind::sector

  friend bool operator==(const TestFunction&, const TestFunction&) = default;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, kind, sector);
  }
};

/// "sector", "krein", "torus".
[[nodiscard]] std::string_view name_of(TestFunction::Kind kind);
/// Whether functions of this kind are of one sector, in which families are born.
[[nodiscard]] bool has_sector(TestFunction::Kind kind);

/// What can happen to orbits of the system whose fundamental map has this order: all sectors (for dissipative systems q
/// = 1 and 2), then krein (two pairs or more) or torus (two multipliers or more). Empty where no multiplier is
/// nontrivial.
[[nodiscard]] std::vector<TestFunction> test_functions(const systems::Structure& system, int fundamental_order,
                                                       int subharmonics);

/// The function at an orbit with `stability.fundamental` (stability indices k_i, or multipliers mu_i): the
/// harmonic mean of the moduli, with the sign of the product, of
///   sector     (k_i - c)/(2 + |k_i|), c = 2 cos(2 pi j/q);  dissipative: (mu_i -+ 1)/(1 + |mu_i|)
///   krein      (k_i - k_j)^2 / (8 + 2 |k_i|^2 + 2 |k_j|^2), i < j: real pairs apart > 0, one complex pair < 0
///   torus      (mu_i mu_j - 1)/(1 + |mu_i mu_j|), i < j
/// with the error that follows from `fundamental_error`. A conserved energy's multiplier 1 is left out.
/// Throws MisuseError if the number of multipliers is not the system's.
[[nodiscard]] Reading evaluate(const TestFunction& function, const systems::Structure& system,
                               const spectrum::Stability& stability);

/// The function with `size` in place of the 2 (dissipative: 1) of a sector's denominator, where it is larger: of the
/// same sign and zeros. Between orbits of indices of -1e13 and 1e13 the function is a step, which a search for its zero
/// can only halve; this one, for 1e13, is nearly linear.
[[nodiscard]] double value_over(const TestFunction& function, const systems::Structure& system,
                                const spectrum::Stability& stability, double size);

/// What an orbit's multipliers tell of the zeros of one function that its family has passed.
struct ZerosPassed {
  TestFunction function{};
  /// How many, but for a constant, of a symplectic system; NaN where that is not known.
  double number = std::numeric_limits<double>::quiet_NaN();
  std::optional<OutsideCircle> outside{};  ///< of a dissipative system

  [[nodiscard]] bool is_known() const { return outside || !std::isnan(number); }

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, function, number, outside);
  }
};

/// Dissipative: the multipliers outside the circle. Symplectic, where a multiplier has turned so far
/// (`Stability::turns`): a number of its zeros. Of several pairs that are no complex quadruplet: how many indices are
/// above the place, which changes by as many as pass it upwards more than downwards. Not known: of functions without a
/// sector, for q = 1 and 2 at orbits that have opened there (an index beyond 2, or -2), where the sign tells, and where
/// an index is at the place within its error.
[[nodiscard]] ZerosPassed zeros_passed(const TestFunction& function, const systems::Structure& system,
                                       const spectrum::Stability& stability);

/// How many zeros of the function have been passed between two orbits of a family, at least (`least_passages`); 0 where
/// that is not known.
[[nodiscard]] int zeros_between(const ZerosPassed& from, const ZerosPassed& to);

/// Whether double precision tells at the orbit what its indices pass: false where one of a pair that is on the unit
/// circle, or near it (|k| <= 3), is known to worse than 1e-4. Beside a motion a thousand times as fast the phase that
/// it gains in a period is known no better, and no crossing could be located by it.
[[nodiscard]] bool are_decided(const spectrum::Stability& stability);

/// Whether the orbit has one index, and that is between -2 and 2 by more than its error.
[[nodiscard]] bool is_elliptic(const spectrum::Stability& stability);

/// False where an index of the fundamental map is 2 to within its error: the linearised equations of the orbit are
/// singular to rounding, and orbits beside it are not told from it.
[[nodiscard]] bool is_isolated(const spectrum::Stability& stability);

/// mu_i + mu_j of the two multipliers whose product is the nearest to 1: at a torus point 2 cos of their angle. Throws
/// MisuseError as `evaluate`, and for a system without torus points.
[[nodiscard]] double torus_sum(const systems::Structure& system, const spectrum::Stability& stability);

/// Whether a zero of the function, located at an orbit with this stability, is what the function is for. No continuous
/// function can tell: krein vanishes as well where two pairs meet off the unit circle (k_i = k_j outside [-2, 2]) and,
/// touching zero (`tangency`), where two pairs pass one another; torus where mu_i mu_j = 1 with both real. None where
/// the two are so near to a double multiplier on the circle that their error bounds leave it open.
[[nodiscard]] std::optional<bool> is_event(const TestFunction& function, const systems::Structure& system,
                                           const spectrum::Stability& stability, bool tangency);

}  // namespace orbweaver::bifurcation
