#pragma once

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// Which solutions of the linearised flow: v(t + T/p) = e^{i angle} g v(t), g@1/p being the fundamental map.
struct FloquetVectorOptions {
  int order = 1;        ///< p
  double angle = 0.0;   ///< radians
  int count = 1;        ///< independent solutions, at least 1: those that come nearest to closing so
  double share = 1e-9;  ///< of the largest harmonic: smaller ones are not needed
  int most = 4096;      ///< the search ends here
  core::Team* team = nullptr;
};

/// How many harmonics of the orbit's period these solutions need, v e^{-i angle p s / 2 pi} being a Fourier series in
/// the loop's own s. That has nothing to do with how many the loop itself needs: beside a slow orbit a fast oscillation
/// needs at least the ratio of the two frequencies. A number above `most` says that `most` do not do.
///
/// The solutions come from the factors of the transverse flow (`floquet`), by orthogonal elimination along the chain:
/// none grows on the way, however unstable the orbit is. Throws what `floquet` throws, and MisuseError if p is no
/// multiple of the order of the fundamental map that the loop's nodes have.
[[nodiscard]] int floquet_vector_cutoff(const systems::System& system, const loop::Loop& loop,
                                        const loop::Isotropy& isotropy, const FloquetVectorOptions& options);

}  // namespace orbweaver::spectrum
