#pragma once

#include <memory>
#include <string>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/equations/orbit_solver.hpp"
#include "predictor.hpp"
#include "regrid.hpp"

namespace orbweaver::continuation {

/// A predicted and corrected point of a branch.
struct Trial {
  bool converged = false;
  std::string reason;  ///< where it has not
  std::vector<double> values;
  int order = 0;  ///< of the prediction
  int iterations = 0;
  double prediction_error = 0.0;
  equations::Collocation::Quality quality{};
  double threshold = 0.0;

  /// An orbit: the loss over the whole loop is under its threshold.
  [[nodiscard]] bool accepted() const { return converged && quality.loss_rms < threshold; }
  /// Why it is none.
  [[nodiscard]] std::string why() const;
};

/// Corrects predicted points of one branch on the grid that its frontier names, and changes that grid.
class PointCorrector {
 public:
  /// All but the start's centre and winding is read from `frontier` and `options`, which must outlive the object.
  PointCorrector(const systems::System& system, const Start& start, loop::FundamentalDomain domain,
                 const Options& options, Frontier& frontier);

  [[nodiscard]] const loop::FundamentalDomain& domain() const { return _domain; }
  /// The equations of the frontier, with the factor that it names.
  equations::Collocation& equations();
  /// A grid with nothing on it yet.
  void set_grid(int cells, const loop::TimeMap& map);
  /// After a change of the frontier: its grid is made anew when it is needed.
  void forget_grid() { _equations.reset(); }
  /// The highest harmonic on a grid of `cells`.
  [[nodiscard]] int cutoff_of(int cells) const { return (cells * _domain.copies() - 1) / 2; }

  /// Takes the time shift since `last` out of a prediction and its direction: a phase that drifts from orbit to orbit would
  /// be extrapolated, and use up the steps.
  void hold_phase(Prediction& prediction, const std::vector<double>& last);
  /// Conditions at a prediction: the change orthogonal to the branch, and to the time shift where the domain has one.
  [[nodiscard]] std::vector<double> conditions_at(const Prediction& prediction);
  Trial correct(Prediction prediction, const std::vector<double>& weights);

  /// False where the trial needs more harmonics. Sets `modes()`. The residual that truncation leaves is about
  /// 2 pi / T K tail: only where that explains a loss above its threshold do more harmonics help.
  [[nodiscard]] bool resolved(const Trial& trial);
  /// What its last harmonics may weigh.
  [[nodiscard]] double tail_limit(const Trial& trial) const;
  /// What the orbit just found needs; none where that is beyond the largest cutoff.
  [[nodiscard]] std::optional<Resolution> finer(const Trial& trial);
  /// A general time map for the last point where that pays, to the accuracy of `of`, a trial near it.
  [[nodiscard]] std::optional<Resolution> remapped(const Trial& of);
  /// Another grid; all points of the frontier move along.
  void regrid(const Resolution& to);

  /// The loop of the last trial that `resolved` looked at, and its energy at s = 0.
  [[nodiscard]] loop::Loop& modes() { return _modes; }
  [[nodiscard]] double energy() const;

  /// The inner product of the steps a - b and c - d in which the branch measures its parameter.
  [[nodiscard]] double product(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                               const std::vector<double>& d);
  /// True if the oscillation is that of `last` upside down: the step jumped across a fixed point, where the family ends
  /// (beyond it lie the same orbits half a period later).
  [[nodiscard]] bool inverted(const Trial& trial, const std::vector<double>& last);

 private:
  void phase_condition(const Prediction& prediction, std::vector<double>& weights);
  void judge(Trial& trial);
  [[nodiscard]] std::string not_finite_at(const std::vector<double>& values, const std::vector<double>& predicted);
  [[nodiscard]] double period_unit(double period) const;
  [[nodiscard]] TraceState& state() { return _frontier.trace; }

  const systems::System& _system;
  loop::FundamentalDomain _domain;
  loop::Isotropy _isotropy;
  std::vector<double> _centre;
  std::vector<double> _winding;
  const Options& _options;
  Frontier& _frontier;
  std::unique_ptr<equations::Collocation> _equations;
  equations::OrbitSolver _solver;
  loop::Loop _modes;
};

}  // namespace orbweaver::continuation
