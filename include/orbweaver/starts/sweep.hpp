#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/starts/shared_periods.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// Oscillations of unit amplitude of which z(s = 0) moves by less are scaled to unit amplitude, not to
/// |dz(s = 0)| = 1: the state there is rounding.
inline constexpr double still_at_start = 1e-9;

/// First orbits are searched for at no smaller amplitude r: terms of the fourth order, which tell some directions from
/// their neighbours, are r^2 of the residual's, ten thousand times the loss's tolerance.
inline constexpr double least_search_amplitude = 1e-3;

/// The range of periods swept at a fixed point.
struct SweepOptions {
  double period_from = 1.0;
  double period_to = 12.0;
  double step = 0.01;
  int cutoff = 10;            ///< harmonics of the loop space whose Hessian is taken
  double amplitude = 8.7e-3;  ///< of the families' first orbits, in scales: decides what is a near resonance
};

/// The range that covers the periods of all oscillations, decided or not, with a margin, in a thousand steps. Where
/// nothing oscillates, the time scales of the other eigenvalues stand for them, and where there is none the default.
[[nodiscard]] SweepOptions automatic_range(const LinearModes& modes);

/// The smallest eigenvalue of H of the constant loop with one period (over all coefficients, period held).
struct SweepPoint {
  double period = 0.0;
  double eigenvalue = 0.0;
};

/// A family of small oscillations that starts at the fixed point.
struct NormalMode {
  double period = 0.0;           ///< to rounding
  double grid_period = 0.0;      ///< the swept period where it shows
  double residual = 0.0;         ///< |(2 pi i/T) v - A v| of its vector of unit length
  loop::Tangent direction;       ///< of a loop with cutoff `SweepOptions::cutoff`, |dz(s = 0)| = 1 (`still_at_start`)
  loop::Tangent grid_direction;  ///< the same from the eigenvector at `grid_period`
  loop::Isotropy isotropy;       ///< of the small oscillations
  /// As SharedPeriod: the family's first orbit has this length in the kernel at most.
  double apart_below = std::numeric_limits<double>::infinity();
};

/// Several oscillations that share a period: which of their combinations families start along, the linear problem does
/// not say (bifurcation::equilibrium_directions).
struct DegenerateMode : SharedPeriod {
  double grid_period = 0.0;
};

/// A dip of the eigenvalue, or a doubt about the modes, that starts no family, and why.
struct RejectedDip {
  double period = 0.0;
  std::string reason;
};

struct SweepResult {
  std::vector<double> fixed_point;
  SweepOptions range;  ///< as swept
  LinearModes linear;
  std::vector<SweepPoint> table;
  std::vector<NormalMode> modes;  ///< in the range, longest period first
  std::vector<DegenerateMode> degenerate;
  std::vector<SharedPeriod> left_out;  ///< outside the range, longest first
  std::vector<RejectedDip> rejected;   ///< period multiples, near misses, resonances, undecided eigenvalues
};

/// The small oscillations at a fixed point whose periods lie in a range, from the Jacobian, and the picture of the
/// paper (section III A): the smallest eigenvalue of the Hessian against T, whose dips the oscillations explain. The
/// step decides about the picture only. Throws MisuseError for an empty or reversed range, a step that is not positive,
/// or a state of another dimension; NotFiniteError where the Hessian is not finite; and as linear_modes does.
[[nodiscard]] SweepResult sweep(const systems::System& system, std::span<const double> fixed_point,
                                const SweepOptions& options);

}  // namespace orbweaver::starts
