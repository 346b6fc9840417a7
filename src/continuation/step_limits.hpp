#pragma once

#include <optional>

#include "branch_end.hpp"
#include "limit_orbit.hpp"
#include "stepper.hpp"

namespace orbweaver::continuation {

/// Where a step is to end: at the orbit that it led to, or before it, on a limit of the scene or on the branch's first
/// orbit. All references must outlive it.
class StepLimits {
 public:
  StepLimits(const systems::System& system, PointProblem& problem, Stepper& stepper, const Options& options,
             Frontier& frontier)
      : _system(system), _problem(problem), _stepper(stepper), _options(options), _frontier(frontier) {}

  /// The orbit at which a step of `length` to `passed` ends, said of the frontier too; none with the reason where there
  /// is none on the limit.
  [[nodiscard]] OnLimit within(const Trial& passed, double length);
  /// What `within` has said of the frontier is not so: the step is taken back.
  void forget();
  /// Whether a limit has had a part since the last `begin`.
  [[nodiscard]] bool met() const { return _met; }
  void begin() { _met = false; }

 private:
  [[nodiscard]] const loop::Loop& here() const { return _frontier.orbit.loop; }
  [[nodiscard]] double scalar(const Trial& trial, int number) const {
    return trial.values[_problem.scalars_at() + static_cast<std::size_t>(number)];
  }
  [[nodiscard]] bool is_beyond_energies(double value) const {
    return value > _options.energy_to || value < _options.energy_from;
  }
  [[nodiscard]] bool is_beyond_parameters(const Trial& trial) const {
    if (_system.family_scalars().free.empty()) return false;
    constexpr int parameter = 1;  // among the scalars
    return continuation::is_beyond_parameters(scalar(trial, parameter), _options);
  }
  [[nodiscard]] bool is_beyond_limits(const Trial& trial) const;
  [[nodiscard]] std::optional<OnLimit> closing_orbit(const Trial& trial, double length);
  [[nodiscard]] std::optional<double> turning_beyond_limit(const Trial& trial) const;
  [[nodiscard]] OnLimit within_guards(Trial trial, double length);

  const systems::System& _system;
  PointProblem& _problem;
  Stepper& _stepper;
  const Options& _options;
  Frontier& _frontier;
  bool _met = false;
};

}  // namespace orbweaver::continuation
