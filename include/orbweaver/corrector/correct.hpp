#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/corrector/method.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::corrector {

/// How a correction ended.
enum class Outcome {
  converged,       ///< an orbit: sqrt(loss) under the threshold, or kept above by rounding, and the Newton step small
  under_resolved,  ///< at a minimum above the threshold, with weight in the last harmonics: raise the cutoff
  stalled,         ///< no further progress, resolution is not the reason
  iteration_limit,
  period_not_positive,
  not_finite,        ///< the field or its derivatives gave NaN or infinity
  singular,          ///< the Hessian on the slice could not be factored
  solver_failed,     ///< TAO gave up; `detail` has its reason
  lost_in_rounding,  ///< an orbit would be accepted, but its speed is not known (`largest_unknown`)
};
[[nodiscard]] std::string_view name_of(Outcome outcome);

/// Every TAO option can be set under the prefix `corrector_`, e.g. -corrector_tao_monitor.
struct Options {
  Method method = Method::automatic;
  int krylov_from = 150;     ///< automatic: unknowns from which newton-krylov is used (measured: docs/performance.md)
  double tolerance = 1e-10;  ///< on sqrt(loss), times min(1, rms |dz/dt|); the paper's
  /// The last Newton step, relative to 1 + |loop|. Under the threshold a step is at most `tolerance` over the smallest
  /// singular value: longer ones show a direction flatter than 1e-4, in which the loss does not hold the orbit.
  double step_tolerance = 1e-6;
  double tail_tolerance = 1e-3;  ///< under_resolved needs truncation (2 pi/T) K tail above this times the threshold
  int max_iterations = 0;        ///< 0: 30 for second-order methods, 200,000 for first-order ones
  loss::Curvature curvature = loss::Curvature::gauss_newton;  ///< Hessian for nls and ntr
  core::Team* team = nullptr;  ///< ranks that divide newton-krylov among them; then `correct` is collective over it
};

struct Result {
  Outcome outcome = Outcome::solver_failed;
  std::string detail;              ///< a sentence for outcomes other than converged
  loop::Loop loop;                 ///< the best loop found,
  std::vector<double> parameters;  ///< and the values that the parameters among the unknowns have there
  int iterations = 0;
  int inner_iterations = 0;    ///< of GMRES, over all Newton steps (newton-krylov)
  double loss_rms = 0.0;       ///< sqrt(loss) of `loop`
  double threshold = 0.0;      ///< what loss_rms had to go under
  bool at_rounding = false;    ///< converged above the threshold, where rounding keeps the loss (`rounding_floor`)
  double tolerance_met = 0.0;  ///< what `tolerance_met` says of it
  double newton_step = 0.0;    ///< length of the last Newton step (second-order: already applied)
  std::optional<Eigen::VectorXd> flat_direction;  ///< of the Hessian through the slice's first condition, if asked for

  [[nodiscard]] bool converged() const { return outcome == Outcome::converged; }
};

/// More harmonics help only where truncation explains at least this share of sqrt(loss). It is an estimate, good to a
/// factor of ten or so; a loss that is all truncation is at about 1 whatever the share. Not measured.
inline constexpr double least_explained = 1e-2;

/// What the rounding of a mean state of size `size` is in the residual, through rms |df/dz| `field_jacobian`:
/// 4 eps |z| |df/dz|. It matters for small amplitudes around a point away from 0.
[[nodiscard]] double state_rounding(double size, double field_jacobian);

/// A loop of which that rounding is a larger part of rms |dz/dt| is no orbit that is known: T is open by this part of
/// itself at most, and a tangent or multipliers likewise. Measured around (0, pi) of the double pendulum: T is off by
/// an eightieth of the part.
inline constexpr double largest_unknown = 1e-2;

/// More unknowns than this are not left to a method with an assembled Hessian, which takes 128 MiB there, where
/// Newton's fails.
inline constexpr int largest_dense = 4000;

/// The rms |dz/dt| at which rounding is just that part.
[[nodiscard]] double least_known_speed(double size, double field_jacobian);

/// A sentence about a loop that is slower.
[[nodiscard]] std::string lost_in_rounding_text(double speed, double size, double field_jacobian);

/// The tolerance that an accepted loop meets where rounding does not let it meet `tolerance`; else 0.
[[nodiscard]] double tolerance_met(double tolerance, double loss_rms, double speed, double size, double field_jacobian);

/// The threshold for sqrt(loss) of a loop with rms |dz/dt| `speed`, mean state of size `size` and rms |df/dz|
/// `field_jacobian`: tolerance * min(1, speed), never below `state_rounding`.
[[nodiscard]] double acceptance_threshold(double tolerance, double speed, double size, double field_jacobian);
/// The same at a loop; the rounding error counts where the linearization has the field's Jacobian.
[[nodiscard]] double acceptance_threshold(const loop::Loop& loop, const loss::Linearization& linearization,
                                          double tolerance);

/// The least length at which `direction`, with unit |dz(s = 0)|, leads from the equilibrium `rest` (a constant loop) to
/// loops of `least_known_speed`; 0 where the field there is not finite, which a correction says better.
[[nodiscard]] double least_known_amplitude(const systems::System& system, const loop::Loop& rest,
                                           const loop::Tangent& direction);

/// What rounding may leave of sqrt(loss) of a loop with K harmonics, whatever the tolerance: that of the modes, of rms
/// size `size`, reaches the residual multiplied by 2 pi K/T and by rms |df/dz| `field_jacobian`, that of the field by
/// rms |dz/dt| `speed`.
[[nodiscard]] double rounding_floor(int cutoff, double period, double size, double speed, double field_jacobian);
/// The same at a loop, with the field's Jacobian where the linearization has it.
[[nodiscard]] double rounding_floor(const loop::Loop& loop, const loss::Linearization& linearization);

/// Optimises the loss over `guess` + slice. `normal`: the slice's condition (the tangent) if the flat direction through
/// it is wanted at the end. Never throws for a numerical outcome. Throws MisuseError for sizes that disagree, and
/// EnvironmentError if PETSc fails otherwise.
[[nodiscard]] Result correct(const systems::System& system, const loop::Loop& guess, const loss::Unknowns& unknowns,
                             const loss::Slice& slice, const Options& options,
                             const std::optional<Eigen::VectorXd>& normal = std::nullopt);

}  // namespace orbweaver::corrector
