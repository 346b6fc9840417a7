#pragma once

#include <optional>
#include <vector>

#include "point_problem.hpp"

namespace orbweaver::continuation {

/// Predicts and corrects points beyond the last one of a frontier. All references must outlive it.
class Stepper {
 public:
  Stepper(PointProblem& problem, const Options& options, Frontier& frontier)
      : _problem(problem), _options(options), _frontier(frontier) {}

  /// From here on on the polynomial again, where the options say so.
  void begin() {
    _tangent.reset();
    _raised = 0;
  }
  /// From here on along the family's own direction: a polynomial through a sharp turn may point backwards, however
  /// short the step.
  void use_tangent();

  /// |dz(s = 0)| of the branch for a step of length 1.
  [[nodiscard]] double change_at_start();
  /// The corrected point at `length` from the last one.
  [[nodiscard]] Trial step(double length);
  /// The same from a prediction, with the scalar of this number held where that is asked for.
  [[nodiscard]] Trial correct(Prediction prediction, std::optional<int> held_scalar = std::nullopt);

  /// True if the step has left its prediction by more than 60 degrees, or turns by as much from the last step and from
  /// the family's direction (the last step may have gone around a bend): a bend that is not resolved, or the way back.
  /// Then the tangent is used from here on.
  [[nodiscard]] bool turned_too_far(const Trial& trial, double length);
  /// True where a trial needs more harmonics. Sets its loop.
  [[nodiscard]] bool needs_more_harmonics(Trial& trial);
  /// More harmonics for the trial; none where the scene does not allow them.
  [[nodiscard]] std::optional<PointProblem::Transfer> refine(const Trial& trial);
  /// Another resolution; the points of the frontier move along.
  PointProblem::Transfer resolve(const Resolution& to);

  [[nodiscard]] PointProblem& problem() { return _problem; }
  [[nodiscard]] const Options& options() const { return _options; }
  [[nodiscard]] const Frontier& frontier() const { return _frontier; }
  [[nodiscard]] const std::vector<double>& last() const { return _frontier.points.back().values; }
  /// The branch's direction at the last point.
  [[nodiscard]] Prediction here() const;

 private:
  [[nodiscard]] Prediction along_tangent();
  [[nodiscard]] Prediction scaled(Prediction step, double length) const;

  PointProblem& _problem;
  const Options& _options;
  Frontier& _frontier;
  std::optional<Prediction> _tangent;  // a step of length 1 along the family, where it is used
  int _raised = 0;                     // times in a row that a correction failed for lack of harmonics
};

}  // namespace orbweaver::continuation
