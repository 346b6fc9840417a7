#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// An equilibrium and the value of the first parameter that moves, both in the system's scales.
struct Equilibrium {
  std::vector<double> state;
  double parameter = 0.0;
};

/// What a point of a curve of equilibria is.
enum class EquilibriumKind {
  regular,
  hopf,
  fold,          ///< the parameter turns
  came_back,     ///< the parameter has the value of the curve's start again
  branch_point,  ///< another curve passes through it
};
[[nodiscard]] constexpr EquilibriumKind last_of(EquilibriumKind) { return EquilibriumKind::branch_point; }

/// An equilibrium of a curve.
struct EquilibriumPoint {
  Equilibrium at;
  EquilibriumKind kind = EquilibriumKind::regular;
  double period = 0.0;             ///< of the small oscillations at a Hopf point
  bool may_branch_before = false;  ///< whether other curves pass through the step to this point is not told
  bool may_pass_before = false;    ///< nor whether a pair of eigenvalues passes the imaginary axis on it
};

/// Where a pair of eigenvalues passes the imaginary axis: a family of periodic orbits begins.
struct HopfPoint {
  Equilibrium at;
  double period = 0.0;  ///< 2 pi/|Im|
  double real_part = 0.0;
  double distance = 0.0;    ///< from the curve's start, along the curve: in scales, by chords
  loop::Tangent direction;  ///< of the small oscillation, of a loop with the cutoff asked for, |dz(s = 0)| = 1
  loop::Isotropy isotropy;  ///< of the small oscillations
};

struct EquilibriumCurve {
  std::vector<EquilibriumPoint> points;  ///< from one end of the curve to the other, those of all kinds
  std::size_t start = 0;                 ///< the one of `points` where the curve was begun
  std::vector<Equilibrium> folds;        ///< where the parameter turns
  std::vector<HopfPoint> hopf;           ///< by the place on the curve
  std::vector<std::string> ends;         ///< why it ends at its first and at its last point
  std::vector<bool> are_cut;             ///< whether it is left there for its length, and goes on
  /// Period of a pair that is on the imaginary axis, to rounding, all along a step: a centre. NaN without one.
  double stays = std::numeric_limits<double>::quiet_NaN();
};

struct EquilibriumCurveOptions {
  double parameter_from = -std::numeric_limits<double>::infinity();
  double parameter_to = std::numeric_limits<double>::infinity();
  double largest_step = 0.1;    ///< of the state and the parameter, in scales; far out a hundredth of their length
  double smallest_step = 1e-8;  ///< below it the curve ends
  int most_points = 5000;       ///< to either side
  double largest_state = 1e6;   ///< a state further from the start has left for infinity
  int cutoff = 10;              ///< of the directions of Hopf points
};

/// The curve of equilibria through the one that Newton's method reaches from `start` at the system's own parameter
/// value, to both sides: Keller's pseudo-arclength continuation (doi:10.1016/B978-0-12-587350-4.50017-3). Hopf points
/// are zeros of the product of the sums of two eigenvalues (the determinant of the bialternate product: Kuznetsov,
/// Elements of Applied Bifurcation Theory, section 10.2.2) where the pair that cancels is imaginary. Branch points are
/// zeros of the determinant of the equation bordered by the curve's direction (Keller, the same); steps are halved
/// until no part has more than one, or several real eigenvalues pass zero at one place. The other curves are not
/// followed. Throws MisuseError for a system without a parameter that moves, NumericalError where no equilibrium is
/// near the start.
[[nodiscard]] EquilibriumCurve follow_equilibrium(const systems::System& system, std::span<const double> start,
                                                  const EquilibriumCurveOptions& options = {});

}  // namespace orbweaver::starts
