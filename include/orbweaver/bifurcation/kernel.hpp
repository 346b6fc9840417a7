#pragma once

#include <vector>

#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// The flat directions at a crossing besides the family's own and the time shift.
struct Kernel {
  loop::Loop base;                      ///< the crossing's orbit, as many times around as born orbits take to close
  loop::Tangent family;                 ///< the direction of the crossing's own family, in the modes of `base`
  std::vector<loop::Tangent> vectors;   ///< with orthonormal modes
  std::vector<double> singular_values;  ///< of the loop's Jacobian in the sector, smallest first

  [[nodiscard]] int dimension() const { return static_cast<int>(vectors.size()); }
  /// The largest singular value of the kernel, and the smallest beside it (NaN where none was computed).
  [[nodiscard]] double largest() const;
  [[nodiscard]] double next() const;
};

struct KernelOptions {
  /// `base` is to have the identity as time map, as starts need it; orbits gone around once are cheaper under their
  /// own.
  bool even_in_time = true;
  /// Vectors whose singular values exceed this do not count (those of the deep survey's kernels are below 9e-9:
  /// docs/performance.md).
  double largest = 1e-5;
  int most_harmonics = 4096;   ///< a period of the crossing's orbit
  core::Team* team = nullptr;  ///< divides the work
};

/// The kernel at an orbit in one sector of its fundamental map (order p, design: m = q/gcd(q, p) times around). Its
/// dimension, at most `expected` (1 for q <= 2 and 2 beyond, times the pairs of multipliers that are there), is where
/// the singular values have their largest gap. `base` has the harmonics that the orbit or the kernel needs, whichever
/// are more (spectrum::floquet_vector_cutoff), or two or four times as many where the vector beside the kernel does not
/// converge with them. Throws UndecidedError where those are too many.
[[nodiscard]] Kernel kernel_of(const systems::System& system, const continuation::CurvePoint& point,
                               const loop::Isotropy& isotropy, const Sector& sector, int expected,
                               const KernelOptions& settings = {});

}  // namespace orbweaver::bifurcation
