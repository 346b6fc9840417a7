#pragma once

#include <memory>
#include <optional>

#include "orbweaver/continuation/family_curve.hpp"

namespace orbweaver::continuation {

/// The stretch of a family between two neighbouring known orbits: its orbits by their share of the chord.
class CurveInterval {
 public:
  virtual ~CurveInterval() = default;
  CurveInterval() = default;
  CurveInterval(const CurveInterval&) = delete;
  CurveInterval& operator=(const CurveInterval&) = delete;

  /// None where the corrector fails. The tangent is left empty unless asked for.
  [[nodiscard]] virtual std::optional<CurvePoint> at(double position, bool with_tangent) = 0;
};

/// An orbit further than this from its prediction, in parts of the chord, belongs to another family.
inline constexpr double largest_correction = 0.2;

/// What an interval is made of: all known orbits, those at `from` and `to` among them.
struct IntervalOf {
  const systems::System& system;
  const loop::Isotropy& isotropy;
  const Options& options;
  const std::vector<FamilyCurve::Known>& known;
  std::size_t last;  ///< index of the orbit at the interval's end; the one before it is at its start
};

/// By collocation on the fundamental domain, as branches are followed. Null where that does not apply.
[[nodiscard]] std::unique_ptr<CurveInterval> make_collocation_interval(const IntervalOf& of);
/// By correction of loops in any subspace.
[[nodiscard]] std::unique_ptr<CurveInterval> make_loop_interval(const IntervalOf& of);

/// The loop under another time map, with enough harmonics for it and at least `cutoff`.
[[nodiscard]] loop::Loop under_map(const loop::Loop& loop, const loop::TimeMap& map, int cutoff);

/// Weights of a polynomial through those of `positions` (up to four, nearest first, well apart) for its value at
/// `position`; zero for the others. `length` of the interval: what is nearer than 1e-4 of it is not apart.
[[nodiscard]] std::vector<double> lagrange_weights(const std::vector<double>& positions, double position,
                                                   double length);

}  // namespace orbweaver::continuation
