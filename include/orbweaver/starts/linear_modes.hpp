#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// Oscillations z = Re(v e^{2 pi i t/T}) of the field linearised at an equilibrium: an imaginary pair +-2 pi i/T of
/// eigenvalues of the Jacobian A.
struct Oscillation {
  double period = 0.0;
  double period_error = 0.0;  ///< how far rounding of A's entries to double could move it
  double residual = 0.0;      ///< largest |(2 pi i/T) v - A v| of the kernel's vectors
  Eigen::MatrixXcd kernel;    ///< orthonormal v, one a column: as many as oscillations share the period

  [[nodiscard]] int multiplicity() const { return static_cast<int>(kernel.cols()); }
};

/// T_slow is a whole number (2 or more) of T_fast to within their errors, so that one harmonic of each meet.
struct Resonance {
  std::size_t slow = 0;  ///< indices of oscillations
  std::size_t fast = 0;
  int ratio = 0;
};

/// Why nothing is said of some eigenvalues.
enum class Doubt {
  defective,   ///< fewer eigenvectors than eigenvalues that are one
  unresolved,  ///< rounding of A's entries could make them one, and their number of oscillations another
  real_part,   ///< a real part below that rounding which no structure of the system holds at zero
};

/// Eigenvalues of which rounding does not tell what they are.
struct UndecidedEigenvalues {
  std::complex<double> mean;  ///< imaginary part >= 0
  int count = 0;
  Doubt doubt = Doubt::defective;

  [[nodiscard]] double period() const;  ///< 2 pi/|Im|, infinite for real ones
};

[[nodiscard]] std::string to_text(const UndecidedEigenvalues& eigenvalues);

/// Of the linearised equilibrium.
enum class LinearStability {
  elliptic,   ///< all eigenvalues imaginary, not zero, and with all their eigenvectors
  stable,     ///< all real parts negative
  unstable,   ///< an eigenvalue has a positive real part
  neutral,    ///< none has, and not all are decided by the linear field: zeros, or imaginary beside negative ones
  undecided,  ///< rounding does not tell
};

[[nodiscard]] constexpr LinearStability last_of(LinearStability) { return LinearStability::undecided; }

[[nodiscard]] std::string to_text(LinearStability stability);

/// All that the Jacobian at an equilibrium says of small motions.
struct LinearModes {
  std::vector<Oscillation> oscillations;  ///< longest period first
  std::vector<Resonance> resonances;      ///< in the order of `slow`, then `fast`
  std::vector<std::complex<double>>
      rest;  ///< decided eigenvalues that do not oscillate for ever, by descending real part
  std::vector<UndecidedEigenvalues> undecided;
  LinearStability stability = LinearStability::undecided;
};

/// What oscillations, `rest` and `undecided` say together.
[[nodiscard]] LinearStability stability_of(const LinearModes& modes);

/// The eigenvalues of the Jacobian at a fixed point, in quadruple precision where the system has it
/// (systems/quad_system.hpp; docs/mathematics.md, "Linear modes"). Throws MisuseError for a state of another dimension,
/// NotFiniteError for a Jacobian that is not finite, NumericalError where the QR iteration fails.
[[nodiscard]] LinearModes linear_modes(const systems::System& system, std::span<const double> fixed_point);

}  // namespace orbweaver::starts
