#pragma once

#include <string>
#include <vector>

#include "search.hpp"

namespace orbweaver::bifurcation {

struct AnglesFound {
  std::vector<FoundOrbit> found;
  double amplitude = 0.0;  ///< of their parts in the kernel
  double force = 0.0;      ///< the largest push that holds an orbit at another angle there
  double noise = 0.0;      ///< what rounding leaves of it
  [[nodiscard]] bool decided() const { return !found.empty(); }
  /// The push is so large that any solver sees it: a thousand times the tolerance on sqrt(loss).
  [[nodiscard]] bool is_plain() const { return force > 1e-7; }
  /// A solver sees it once orbits are found: a hundred times that tolerance.
  [[nodiscard]] bool is_visible() const { return force > 1e-8; }
};

/// The angles at which orbits leave `base` in a plane kernel of a conservative system that q rotations map to itself, q
/// >= 2.
///
/// At an amplitude r and any angle there is an orbit of the PushedSystem whose part in the kernel lies there; its push
/// is an odd function of the reduced action's derivative by the angle, r^(q - 2) sin(q (angle - a)) to lowest order,
/// and vanishes where orbits of the system itself lie. Its sign changes over a turn by 2 pi/q are located, which is
/// possible as long as the push exceeds its noise, far below the loss's tolerance. Amplitudes grow from a hundredth of
/// `scale` until the push is plain. First comes the zero through which the push rises in the sense of time, and with
/// odd q that one alone: the other is its opposite. Below `least_weak_resonance`, the one of the longer period.
[[nodiscard]] AnglesFound search_angles(const systems::System& system, const loop::Loop& base,
                                        const KernelActions& group, const loop::Isotropy& isotropy, int q, double scale,
                                        const DirectionOptions& options);

}  // namespace orbweaver::bifurcation
