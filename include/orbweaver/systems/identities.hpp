#pragma once

#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// How far a system's field and conserved quantities are from something that its structure says of them.
struct IdentityError {
  std::string identity;       ///< "f(S z) = S f(z)"
  std::vector<double> state;  ///< where the error is largest
  double error = 0.0;         ///< there, relative to what is compared; NaN if only one side is a finite number
};

/// The error of every identity that the structure of `system` promises, the largest over `states`:
///   conserved quantities   grad Q . f = 0, relative to the sum of |dQ/dz_i f_i|
///   equivariances          f(S z) = S' f(z)
///   reversors              f(R z) = -R' f(z)
///   angles                 f(z + 2 pi e_i) = f(z)
///   a drive                f_phase is the same everywhere
///   the energy             H(S z) = H(z), H(R z) = H(z), H(z + 2 pi e_i) = H(z): images of an orbit have its energy
/// Fields are compared coordinate by coordinate, relative to the larger of the coordinate's field there and its median
/// over the states, energies likewise: so the errors do not depend on units. States where the field is not finite are
/// passed over.
[[nodiscard]] std::vector<IdentityError> identity_errors(const System& system,
                                                         const std::vector<std::vector<double>>& states);

/// The error of what `symplectic` says at an equilibrium: eigenvalues of the Jacobian J come in pairs +-lambda, so the
/// trace of every odd power of J below the dimension d vanishes. Relative to d r^k, r being the largest eigenvalue of
/// the matrix of the absolute values of J's entries, and the largest of all k: so it does not depend on units.
/// (Elsewhere the trace of J need not vanish: the form may vary.)
[[nodiscard]] IdentityError pairing_error(const System& system, const std::vector<double>& equilibrium);

/// Whether a system that declares no symplectic form may have one all the same: its dimension is even, the pairs of
/// `pairing_error` are there at each of these equilibria (at least one) and, where it names no energy, the field keeps
/// volumes. All that may be so without a form.
[[nodiscard]] bool may_be_symplectic(const System& system, const std::vector<std::vector<double>>& equilibria);

/// States to try identities at: `count` of them around each of `points`, repeatable, angles up to 1 rad away, other
/// coordinates up to `size`.
[[nodiscard]] std::vector<std::vector<double>> states_around(const Structure& structure,
                                                             const std::vector<std::vector<double>>& points, int count,
                                                             double size);

/// Throws core::InputError where the field is finite and its Jacobian is not, or where the system contradicts its
/// structure beyond rounding, at `equilibria` and other
/// `states` (sizes dimension) and around them, as far as their largest coordinate and 1: an identity above, eigenvalues
/// at an equilibrium that do not pair though it is symplectic, or a guard that is not positive at one of them. The
/// message says which, by how much, and where. Takes well below a millisecond for an equilibrium.
void require_identities(const System& system, const std::vector<std::vector<double>>& equilibria,
                        const std::vector<std::vector<double>>& states = {});

}  // namespace orbweaver::systems
