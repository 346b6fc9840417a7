#pragma once

#include <limits>
#include <memory>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/structure.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// True for families of a symplectic system whose orbits no reversor maps to themselves. A multiplier 1 of the
/// fundamental map has an eigenvector that keeps all symmetries then, so that along such a family an index passes 2
/// only where the energy turns (docs/mathematics.md, "Families that nearly cross").
[[nodiscard]] bool passes_two_only_at_folds(const systems::Structure& system, const loop::Isotropy& isotropy);

/// An orbit with its stability.
struct KnownStability {
  const continuation::Orbit& orbit;
  const spectrum::Stability& stability;
  /// By how much the test function of an index of 2 has changed over the step that led there, in its length.
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// That slope.
[[nodiscard]] double slope_to_two(const systems::Structure& system, const spectrum::Stability& before,
                                  const spectrum::Stability& after, double length);

/// True if the sense in which neighbours go around (`Stability::twist`, of several pairs that in one plane of
/// `Stability::rotations`) differs between two orbits whose index is nearer to 2 than to -2. Along one family it would
/// have had to pass 2 twice on the way.
[[nodiscard]] bool passes_one_unseen(const spectrum::Stability& from, const spectrum::Stability& to);

/// True if the angles by which neighbours of two elliptic orbits go around in a fundamental period differ by more than
/// a quarter of a turn: what was passed on the way cannot be told. A step 1.6 times as long as one that was accepted
/// turns by less than three quarters while the angle changes less than twice as fast, and is seen.
[[nodiscard]] bool rotates_too_far(const spectrum::Stability& from, const spectrum::Stability& to);

/// True unless an index is so large that it is between -2 and 2 on less than `smallest_jump` of the way between two
/// orbits, of the given length: where families are nearer than that they cross to rounding, and turns tell nothing.
[[nodiscard]] bool are_turns_asked(const spectrum::Stability& from, const spectrum::Stability& to, double length,
                                   double smallest_jump);

/// Whether the orbits between the first and the last known one of a family are one curve: halved again and again, all
/// pieces of it shrink. Across a gap between two families one does not. False too where orbits between cannot be had.
[[nodiscard]] bool is_one_curve(continuation::FamilyCurve& step);

/// True if a step along a family that passes 2 only at folds has gone over to another one: an index has passed 2, and
/// the energy does not turn on the way, or the orbits between are not one curve on which it is 2. Also where that
/// cannot be told, which a shorter step may change: neighbours of the two orbits go around by angles too far apart
/// (`rotates_too_far`), the directions of the family at the two orbits cannot be had, or one turns too far from the
/// chord (`least_cosine` of the options). On other families of a symplectic system: an index has passed 2, and no orbit
/// between the two has it. Along a parameter, of systems without pairs of multipliers: an odd number of them has passed
/// 1 where the parameter does not turn, and no orbit between has one. On all of them: the prediction was far off
/// (`Orbit::halvings`), or an index was on its way through 2 (`slope` of `from`) and has not passed it, and the orbits
/// between are not one curve.
[[nodiscard]] bool has_jumped(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                              const continuation::Options& options, const KnownStability& from,
                              const KnownStability& to);

}  // namespace orbweaver::bifurcation
