#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::bifurcation {

/// A symmetry e that the orbits of a branch lack and that an orbit between two of them may have.
struct SymmetryGain {
  std::string name;  ///< "1" for the identity
  bool reversing = false;
  systems::AffineMap map;
  int shift_numerator = 0;  ///< p and q of z(t + T p/q) = M z(t); a reversor's phase is any number instead
  int shift_denominator = 1;
  double phase =
      0.0;  ///< of a reversor at the first of the two orbits: the phi at which z(T phi - t) is closest to M z(t)
};

/// Watches a branch for orbits with more symmetry than its own isotropy: there it meets a more symmetric family, at one
/// of that family's crossings (docs/mathematics.md, "Arrivals").
///
/// Candidates are every declared equivariance with shifts p/q, q <= `largest_order`, and the identity with shifts 1/q,
/// q <= `largest_repetition`, that the own isotropy does not generate, and, if it has no reversor, the declared
/// reversors at any phase. With c(z) = e z - z, the broken part (of a repetition 1@1/q: the harmonics that are no
/// multiples of q), the signed part of an orbit B seen from A is <c(A), c(B)> / <c(A), c(A)>: 1 at A, and of the other
/// sign beyond an orbit with the symmetry e. Inner products are means over time, of as many samples as it takes for
/// what they leave out to be small beside the broken part. Orbits A and B are neighbours of one branch, with its phase
/// convention.
class SymmetryWatch {
 public:
  SymmetryWatch(const systems::Structure& system, const loop::Isotropy& own, int largest_order = 12,
                int largest_repetition = 100);

  /// An orbit as the watch sees it: its harmonics in time, those of 240 samples at first. Worth keeping from one step
  /// to the next.
  struct SampledOrbit {
    loop::Loop source;              ///< the orbit, under any time map
    loop::Loop loop;                ///< evenly in time
    Eigen::MatrixXcd coefficients;  ///< dimension x harmonics, sum of |.|^2 = mean of |z|^2 (less the winding)
    double size = 0.0;
    double left_out = 0.0;  ///< size of the harmonics that `loop` leaves out or takes for lower ones
  };
  [[nodiscard]] static SampledOrbit sampled(const loop::Loop& loop);

  /// All candidates whose broken part turned round between `a` and `b`, or vanishes at `b`, those that generate the
  /// most together with the own isotropy first. Broken parts below 1e-8 of the loop at `a` are rounding, and pass
  /// nothing. Where it vanishes at `b` to that size, `b` lies on the crossing, or the corrector has slipped onto the
  /// symmetric family.
  [[nodiscard]] std::vector<SymmetryGain> all_passed(const SampledOrbit& a, const SampledOrbit& b) const;

  /// The candidates without reversors whose broken part is less than a fifth of the amplitude at `b`, and smaller than
  /// at `a`, those that generate the most first: the branch is on its way to an orbit that has them.
  [[nodiscard]] std::vector<SymmetryGain> nearly_gained(const SampledOrbit& a, const SampledOrbit& b) const;

  /// The signed part of `at` seen from `a`: its root between two orbits is where `gain` may hold.
  [[nodiscard]] double signed_part(const SymmetryGain& gain, const loop::Loop& a, const loop::Loop& at) const;
  /// |c(at)| / |c(a)|: small where `gain` holds. At a root of the signed part where the broken part has only turned,
  /// it is not.
  [[nodiscard]] double relative_size(const SymmetryGain& gain, const loop::Loop& a, const loop::Loop& at) const;
  /// Whether `power`, a gain without a reversor, is in the group that `gain` generates with the own isotropy.
  [[nodiscard]] bool generates(const SymmetryGain& gain, const SymmetryGain& power) const;

 private:
  struct Products;
  class Correlation;
  [[nodiscard]] Eigen::MatrixXcd broken_part(const SymmetryGain& gain, const systems::AffineMap& inverse,
                                             const SampledOrbit& orbit, double shift) const;
  [[nodiscard]] Products compare(const SymmetryGain& gain, const SampledOrbit& a, const SampledOrbit& b) const;
  /// Two orbits, and what a candidate needed of them beyond their first samples, for those after it.
  struct Resolved;
  /// The same with as many harmonics as the broken parts ask for; the phase of a reversor moves along.
  [[nodiscard]] Products compare_resolved(SymmetryGain& gain, Resolved& orbits) const;
  [[nodiscard]] loop::Isotropy group_with(const SymmetryGain& gain) const;
  [[nodiscard]] std::size_t generated_with(const SymmetryGain& gain) const;

  systems::Structure _system;
  loop::Isotropy _own;
  struct Shifted {  // one matrix with all its shifts
    systems::Symmetry symmetry;
    std::vector<SymmetryGain> candidates;
  };
  std::vector<Shifted> _equivariances;
  std::vector<systems::Symmetry> _reversors;
};

}  // namespace orbweaver::bifurcation
