#pragma once

#include <limits>
#include <memory>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::certificate {

/// How much is asked of a certificate.
enum class Level {
  none,     ///< nothing
  closure,  ///< integrations of the field, and what the loop says by itself
  full,     ///< transition matrices as well: distance to the true orbit, multipliers
};
[[nodiscard]] constexpr Level last_of(Level) { return Level::full; }

struct Options {
  Level level = Level::closure;
  int segments = 32;  ///< equal parts of the period, at least; as many more as the isotropy's time shifts ask for
  double tolerance = 1e-13;  ///< of the integrator (integrate.hpp)
};

/// What was not computed.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What an independent integrator says of one loop. Distances are Euclidean in the coordinates of phase space; an angle
/// that turns n times is expected to have grown by 2 pi n after a period. NaN: not computed, or not for such a system.
struct Certificate {
  double closure = unknown;  ///< largest |z(t_m+1) - Phi(z(t_m))| over the segments, z being the loop
  /// The same by Taylor series (taylor/flow.hpp), which share the field only, over one each of the segments that the
  /// isotropy makes images of one another.
  double taylor_closure = unknown;
  double apart = unknown;  ///< the largest distance of the two integrators' ends there: what either may be wrong by
  double beside_flow = unknown;  ///< the closure but for what a wrong period explains: gaps along the field, all alike
  /// |z(T) - Phi_T(z(0))|: once around without help; grows with the largest multiplier; NaN if that fails.
  double single_shot = unknown;
  double energy_drift = unknown;     ///< largest |H(z(t_m)) - H(z(0))|
  double other_drift = unknown;      ///< the same of the other conserved quantities, each in its scale
  double symmetry_defect = unknown;  ///< largest |z(t_m) - g z(t_m)| over the isotropy's elements g
  double recurrence = unknown;       ///< least distance from an orbit gone around m times, m prime
  double tail = unknown;             ///< loop::tail
  double reach = 0.0;                ///< largest |z(t_m)|
  /// How many times farther than at its start a displacement is once around, where the orbit returns so far off that it
  /// matters, and farther than the known growth explains: one along dH/dz, or, where nothing is conserved, that of the
  /// coordinates which grows most; where that and the known growth do not explain the return, from whichever of the
  /// instants t_m to the end.
  double displaced_growth = unknown;
  double steepness = 0.0;    ///< largest |dH/dz(z(t_m))|; 0 for a system that conserves no energy
  double energy_size = 0.0;  ///< largest |H(z(t_m))|, of which its rounding is a part
  /// Largest bound on what rounding makes of H(z(t_m)), where terms that cancel too (model/rounded.hpp). 0: not
  /// computed, as where the drift is within the rounding of its sum, or for a system that does not give its formulas.
  double energy_rounding = 0.0;

  // Level::full
  double distance = unknown;     ///< to the true orbit, by two steps of Newton's method for the states at t_m and T
  double contraction = unknown;  ///< the second step in parts of the first: an orbit is near where that is well below 1
  double pairing = unknown;      ///< |mu_1 mu_2 ... - 1| of all nontrivial multipliers, symplectic systems
  double index = unknown;        ///< mu + 1/mu of a single pair
};

/// Checks the loops of one family, one after the other.
class Certifier {
 public:
  /// `isotropy`: what the family claims. Throws core::MisuseError if `segments` < 1 or the tolerance is out of range.
  Certifier(const systems::System& system, const loop::Isotropy& isotropy, const Options& options = {});
  ~Certifier();
  Certifier(Certifier&&) noexcept;

  /// Integrates the loop's own states and compares. Deterministic; knows no residual, loss or Hessian. A system that
  /// does not give its formulas has no Taylor series. `known_growth`: the largest modulus of its multipliers or
  /// indices, or NaN; where it explains how far off the orbit returns, no other explanation is looked for.
  /// Throws core::MisuseError if the loop is not valid or not of the system's dimension; core::NumericalError if an
  /// integration of a segment fails, saying in which and at what time.
  [[nodiscard]] Certificate operator()(const loop::Loop& loop, double known_growth = unknown);

 private:
  class Parts;
  std::unique_ptr<Parts> _parts;
};

/// The same for one loop.
[[nodiscard]] Certificate certify(const systems::System& system, const loop::Loop& loop,
                                  const loop::Isotropy& isotropy = {}, const Options& options = {});

}  // namespace orbweaver::certificate
