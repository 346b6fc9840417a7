#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::benchmarks {

/// How far a produced orbit is from the true one.
struct OrbitError {
  double distance = 0.0;        ///< max over the finer grid's nodes and over coordinates of |z - z_true|
  double reference_step = 0.0;  ///< last Newton step of the finer solve: how well it is known itself
};

/// Distance of `orbit` to the nearest orbit of its family. `neighbour`: another orbit of the family close by (it gives
/// the direction along the family), `isotropy`: that of the true orbits.
///
/// The nearest orbit, not the one of equal period: at small amplitude the period hardly changes along a family, so that
/// at equal T an error of 1e-16 in T is a difference of 1e-16 / (dT/da) in the loop, which says nothing of the solver.
/// So the finer solve (twice the harmonics, to rounding, in the symmetric subspace that holds the true orbit) keeps the
/// arclength condition (its correction is orthogonal to the family), and from the difference the parts along the family
/// and along the time shift are subtracted, by least squares over the nodes.
///
/// Throws NumericalError if the finer solve fails.
[[nodiscard]] OrbitError error_of(const systems::System& system, const loop::Loop& orbit, const loop::Loop& neighbour,
                                  const loop::Isotropy& isotropy);

}  // namespace orbweaver::benchmarks
