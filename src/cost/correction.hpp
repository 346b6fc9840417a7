#pragma once

#include <string>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/time_map.hpp"
#include "setting.hpp"

namespace orbweaver::cost {

/// A loop with the family's direction there.
struct Directed {
  loop::Loop loop;
  loop::Tangent tangent;
};

/// A probe under another time map, with another cutoff.
[[nodiscard]] Directed expanded(const Probe& probe, const loop::TimeMap& map, int cutoff);

/// The probe pushed off by a smooth perturbation orthogonal to its family, whose largest coordinate is as large as the
/// error that a branch allows its predictions (continuation::Options::prediction_error), of small orbits in proportion.
[[nodiscard]] Directed pushed_off(const Setting& setting, const Probe& probe);

/// A probe's orbit with a number of harmonics, as a problem for the correctors: the orbit in the plane through `guess`
/// across the family.
class Correction {
 public:
  /// `isotropy`: the subspace of these symmetries; none: the whole loop, its phase held.
  Correction(const Setting& setting, Directed guess, const loop::Isotropy& isotropy);

  /// Throws nothing for a numerical outcome. `iterations`: at most; 0: the method's own bound.
  [[nodiscard]] corrector::Result by(corrector::Method method, double tolerance, int iterations = 0,
                                     core::Team* team = nullptr) const;
  [[nodiscard]] int unknowns() const { return _unknowns.size(); }

 private:
  const Setting& _setting;
  Directed _guess;
  loss::Unknowns _unknowns;
  loss::Slice _slice;
};

/// The same by collocation on the fundamental domain, as branches do it.
struct CollocationResult {
  loop::Loop loop;
  bool converged = false;
  int iterations = 0;
  int unknowns = 0;
  std::string reason;  ///< why not
};
/// The orbit in the plane through `through` across the family (its own lengths are other ones than those of modes).
[[nodiscard]] CollocationResult by_collocation(const Setting& setting, const Directed& guess, const loop::Loop& through,
                                               int cells, double tolerance);
/// Why it does not apply; empty where it does.
[[nodiscard]] std::string obstacle_to_collocation(const Setting& setting);
/// The least number of cells that resolve as many harmonics.
[[nodiscard]] int cells_for(const Setting& setting, int cutoff);

}  // namespace orbweaver::cost
