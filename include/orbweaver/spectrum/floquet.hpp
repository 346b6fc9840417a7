#pragma once

#include <complex>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// How finely the variational equations are integrated.
struct FloquetOptions {
  int least_segments = 48;   ///< Runge-Kutta steps a period, at least
  double tolerance = 5e-10;  ///< on the relative truncation error as estimated; above it the steps are refined
  int refinements = 3;       ///< how often, by at most a half each time
  core::Team* team =
      nullptr;  ///< ranks that divide segments and probes among them, with the same bits; then collective
};

/// How neighbours of an orbit go around in the invariant plane of one pair of multipliers on the unit circle.
struct Rotation {
  double angle = 0.0;  ///< of the multiplier, between 0 and pi
  /// Two orthonormal vectors at s = 0, a column each: neighbours go from the first towards the second.
  Eigen::Matrix<double, Eigen::Dynamic, 2> plane;
};

/// The linear stability of one orbit. Multipliers that belong to the flow and to the conserved energy are taken out by
/// restricting the linearised flow to the kernel of dH modulo f, not by closeness to 1.
///
/// Symplectic systems: `full` and `fundamental` hold the stability indices k = mu + 1/mu, one a pair of nontrivial
/// multipliers. Others: the multipliers themselves but for the flow's own; where energy is conserved one of them is
/// exactly 1. Largest modulus first, then largest imaginary part. What is beyond double precision's range is not a
/// number, with its error, and the others are kept.
///
/// The fundamental map of an orbit with z(t + T/p) = g z(t), p as large as its isotropy allows, is P = g^-1 M(T/p), M
/// being the transition matrix of the linearised flow. Without such a symmetry p = 1 and P is the monodromy matrix.
struct Stability {
  std::vector<std::complex<double>> full;         ///< of the full period
  std::vector<double> full_error;                 ///< bound on the absolute error of each
  int fundamental_order = 1;                      ///< p
  std::vector<std::complex<double>> fundamental;  ///< of P
  std::vector<double> fundamental_error;          ///< bound on the absolute error of each
  /// In four dimensions, symplectic: (P_21 - P_12)/2 of the transverse map in an orthonormal basis that is oriented the
  /// same way along a family. Of an elliptic orbit (|k| < 2) its sign is the sense in which neighbours go around, and
  /// |twist| >= |sin| of the angle: along a family it changes only where a multiplier passes 1 or -1. NaN otherwise.
  double twist = std::numeric_limits<double>::quiet_NaN();
  /// In four dimensions, symplectic, for a state of two positions and their velocities or momenta: the turns by which
  /// neighbours go around in T/p, counted along the orbit in a frame that is continuous along families too. Of an
  /// elliptic orbit a whole number plus the angle of the multiplier, in the sense of `twist`; of others the whole (k >=
  /// 2) or half (k <= -2) number. Along a family it is continuous, and so says what is passed between two orbits. NaN
  /// otherwise, and where the chain's segments are too long to tell.
  double turns = std::numeric_limits<double>::quiet_NaN();
  /// Symplectic, where there is no `twist`: one of each pair that is on the unit circle by more than its error. Along a
  /// family planes are continuous, and the sense in which neighbours go around in one changes only where its index
  /// passes 2 or -2.
  std::vector<Rotation> rotations;
  /// Symplectic: P of the transverse flow in an orthonormal basis, where no multiplier is so large that rounding hides
  /// the others in it; empty otherwise.
  Eigen::MatrixXd map;
};

/// Stability of an accepted orbit, at a cost proportional to the number of its harmonics.
///
/// Transition matrices over segments equal in s: along the loop itself by two-point Hermite steps of order 16 where its
/// harmonics are resolved and it has fewer than eight coordinates, else shorter ones, each started at the loop's own
/// state (Dormand and Prince's order 8 from Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I,
/// section II.5), only over T/p, short ones over half of that where `isotropy` has a reversor; the index of a single
/// pair is the trace of their product, others come
/// from orthogonal iteration on the product, so that large and small multipliers keep their digits. The error bound
/// adds the truncation (a tenth of what the embedded methods of lower order differ), the rounding, and the orbit's own
/// error: the response to one Newton step of multiple shooting, at (nearly) fixed period where the system is
/// conservative.
///
/// Throws MisuseError if the loop is not valid, not of the system's dimension, or constant, or if the system conserves
/// more than one quantity, since only one's multipliers are taken out; NotFiniteError if the field
/// is not finite, or nothing of the fundamental map is within double precision's range.
[[nodiscard]] Stability floquet(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                                const FloquetOptions& options = {});

}  // namespace orbweaver::spectrum
