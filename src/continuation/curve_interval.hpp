#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "orbweaver/continuation/family_curve.hpp"
#include "point_problem.hpp"

namespace orbweaver::continuation {

/// The stretch of a family between two neighbouring known orbits: its orbits by their share of the chord.
class CurveInterval {
 public:
  /// From the known orbit before `last` to that one; the others support the predictions. All references must outlive
  /// the interval.
  CurveInterval(const systems::System& system, const loop::Isotropy& isotropy, const Options& options,
                const std::vector<FamilyCurve::Known>& known, std::size_t last);

  /// None where the corrector fails. The tangent is left empty unless asked for.
  [[nodiscard]] std::optional<CurvePoint> at(double position, bool with_tangent);

 private:
  [[nodiscard]] std::optional<Trial> solve(double position);
  /// Orbits on the way stay among the points where it leads to one.
  [[nodiscard]] std::optional<Trial> approach(double position);
  [[nodiscard]] std::optional<Trial> approach(double position, int halvings);
  /// A known orbit itself, which the corrector may fail to find again; none between the two.
  [[nodiscard]] std::optional<Trial> known_at(double position) const;
  [[nodiscard]] CurvePoint taken(double position, Trial trial, bool with_tangent);
  void add_tangent(const std::vector<double>& values, CurvePoint& point);
  [[nodiscard]] bool slipped(const Trial& trial, const Prediction& prediction);
  [[nodiscard]] Prediction prediction_at(double position);

  const Options& _options;
  double _from;
  double _to;
  ProblemState _state;
  std::unique_ptr<PointProblem> _problem;
  std::vector<TracePoint> _points;  // known and found
  std::size_t _first = 0;           // of the interval, among the points
  std::size_t _last = 0;
  std::array<loop::Loop, 2> _ends;  // under the interval's time map
  std::vector<CurvePoint> _found;
  bool _is_refused = false;  // the last solve, by GMRES too
  double _reach = 1.0;       // of corrections, in parts of what they may be on the whole chord
};

}  // namespace orbweaver::continuation
