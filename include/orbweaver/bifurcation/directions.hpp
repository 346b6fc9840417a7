#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/starts/shared_periods.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// From this order on families leave a crossing of orbits without reversors so nearly in all directions that rounding
/// may decide among them: terms of order q - 2 alone fix the angle (docs/mathematics.md, "Angles"). Below it, terms of
/// the order of the amplitude or its square do, and Newton's method finds it by itself.
inline constexpr int least_weak_resonance = 5;

/// To one side (+1) along `tangent`, to the other (-1) along `opposite`, or -tangent where that is empty.
[[nodiscard]] loop::Tangent way_to_side(const loop::Tangent& tangent, const loop::Tangent& opposite, int side);

/// One direction in which a family leaves a crossing.
struct Direction {
  loop::Loop base;          ///< the crossing's orbit as the born family sees it: m times around, started where the born
                            ///< orbits' reversor, if they have one, has phase 0
  loop::Tangent tangent;    ///< in the modes of `base`, which have unit length: in the kernel, or the whole way to an
                            ///< orbit found, T with it
  loop::Isotropy isotropy;  ///< of the born orbits (and of base): generators as loop::find_isotropy gives them
  bool both_sides =
      false;               ///< true: the opposite leads to other orbits; false: a symmetry or time shift maps the sides
  double amplitude = 0.0;  ///< 0: exact, any amplitude leads there; else found by a search at this amplitude, below
                           ///< which the loss hardly tells neighbouring directions apart
  bool is_hidden = false;  ///< what tells it from neighbouring directions is so small, as far from the crossing as
                           ///< orbits were found, that the family cannot be followed: it is known for what arrives
                           ///< along it
  int images = 1;          ///< at an equilibrium: oscillations that the system's symmetries make of this one, time
                           ///< shifts aside, itself among them
  int repetitions = 1;     ///< at an equilibrium: how many times the direction goes around its own period
  loop::Tangent opposite{};  ///< the way to the other side's orbits, where one was found; empty: -tangent

  /// side: +1 or, where there are both, -1.
  [[nodiscard]] loop::Tangent way(int side) const { return way_to_side(tangent, opposite, side); }
};

struct DirectionOptions {
  double symmetry_tolerance = loop::symmetry_tolerance;  ///< of the base loop's symmetries, as loop::find_isotropy
  /// How far symmetries may take kernel vectors out of the kernel: these are good to 1e-6, and one that is missing or
  /// wrong shows as a number of order 1.
  double kernel_tolerance = 1e-4;
  /// The direction of the base's own family, in the modes of the base: orbits that are born may lie along it. Empty at
  /// an equilibrium.
  loop::Tangent family{};
  /// Length in the kernel at which the families that leave an equilibrium are there. Their directions are searched for
  /// at twice that, doubled below 0.3 while there are some that are not isolated.
  double amplitude = 0.01;
  int seeds = 12;                  ///< of a search in a plane; 2^(n-1) times as many in n > 2 dimensions
  corrector::Options corrector{};  ///< of a search
};

/// The directions in which families leave a crossing or an equilibrium.
struct Directions {
  std::vector<Direction> found;
  int not_isolated = 0;  ///< orbits found of which neighbours along the kernel satisfy the loss too: not among `found`
  std::string doubt{};   ///< why there may be others; empty: these are all
};

/// Rounding decides in which directions families leave: terms of high order that alone do are too small.
class UndecidedError : public core::NumericalError {
 public:
  using core::NumericalError::NumericalError;
};

/// The directions in which families leave `base` along its kernel (docs/mathematics.md, "Kernels and directions"),
/// those with a reversor first, in the system's order of reversors.
///
/// base: the crossing's orbit gone around m times (identity time map), or the constant loop at an equilibrium.
/// isotropy: generators of the crossing's orbit; base must have each of them, whatever its shift.
/// kernel: null vectors with orthonormal modes; at an equilibrium each of one harmonic, both phases of each
/// oscillation. Throws MisuseError for sizes that disagree or vectors that are not orthonormal, NumericalError where
/// the symmetries do not map the kernel to itself isometrically, or where no direction is found or, at a crossing, all
/// are a continuum, UndecidedError where they are isolated, but not to double precision.
[[nodiscard]] Directions directions(const systems::System& system, const loop::Loop& base,
                                    const loop::Isotropy& isotropy, const std::vector<loop::Tangent>& kernel,
                                    const DirectionOptions& options = {});

/// The same at an equilibrium where several oscillations Re(v e^{iks}) share one period, exactly or nearly: those that
/// symmetries single out, which are exact, then those found by a search, by their periods, the longest first. In nearly
/// shared periods they are those of orbits of the amplitude searched at.
[[nodiscard]] Directions equilibrium_directions(const systems::System& system, std::span<const double> point,
                                                const starts::SharedPeriod& shared, int cutoff,
                                                const DirectionOptions& options = {});

}  // namespace orbweaver::bifurcation
