#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "branch_end.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "point_problem.hpp"
#include "step_limits.hpp"
#include "stepper.hpp"

namespace orbweaver::continuation {

/// Follows a branch, whatever its points are.
class Tracer {
 public:
  Tracer(std::shared_ptr<const systems::System> system, Start start, Options options);

  [[nodiscard]] std::optional<Orbit> advance();
  [[nodiscard]] const std::optional<Ending>& ending() const { return _ending; }
  [[nodiscard]] const Frontier& frontier() const { return _frontier; }
  /// Whether limits had a part in the last advance: a step that was tried led beyond one.
  [[nodiscard]] bool met_limit() const { return _limits.met(); }
  void go_on_from(Frontier frontier);
  /// Sets the frontier's tangent if it is not known yet.
  void complete_frontier();

 private:
  [[nodiscard]] bool begun() const { return !here().modes.empty(); }
  [[nodiscard]] const loop::Loop& here() const { return _frontier.orbit.loop; }
  [[nodiscard]] double scalar(const Trial& trial, int number) {
    return trial.values[_problem->scalars_at() + static_cast<std::size_t>(number)];
  }

  std::optional<Orbit> first_orbit();
  /// The start's base itself, corrected with one scalar held.
  std::optional<Orbit> base_orbit();
  [[nodiscard]] loop::Tangent start_direction() const;
  std::optional<Orbit> next_on_family();
  /// With a step of at most this length.
  std::optional<Orbit> next_orbit(double at_most);
  [[nodiscard]] bool has_passed_rest(const Trial& trial);
  [[nodiscard]] bool resolve_twice();
  [[nodiscard]] double length_to_try();
  Orbit accept(const Trial& trial);
  /// Makes `orbit`, whose loop and numbers are set, the frontier's; `increment`: arclength from the one before.
  void keep(Orbit& orbit, double increment, double amplitude);
  void keep_guards(const loop::Loop& loop);
  std::optional<Orbit> end(EndReason reason, std::string detail);

  std::shared_ptr<const systems::System> _system;
  Start _start;
  Options _options;
  Frontier _frontier;
  std::optional<Ending> _ending;
  std::unique_ptr<PointProblem> _problem;
  int _halvings = 0;  // Orbit::halvings of the step that is being accepted
  Stepper _stepper;
  StepLimits _limits;
};

}  // namespace orbweaver::continuation
