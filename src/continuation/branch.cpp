#include "orbweaver/continuation/branch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "branch_end.hpp"
#include "loop_problem.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "tracer.hpp"

namespace orbweaver::continuation {

Branch::Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options) {
  loop::validate(start.base);
  core::require(start.direction.modes.size() == start.base.modes.size(),
                "a start's direction needs the size of its base loop's modes");
  core::require(start.direction.norm() > 0.0, "a start's direction must not be zero");
  core::require(options.predictor_order >= 1, "a predictor needs a polynomial of degree 1 or more");
  core::require(loop::is_invariant(start.base.time_map, start.isotropy),
                "the time map of a start must have the symmetries of its isotropy");
  for (const auto& [name, limit] : options.guard_limits) (void)guard_number(system->structure(), name);
  _tracer = std::make_unique<Tracer>(std::move(system), start, std::move(options));
}

Branch::Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options, Frontier from)
    : Branch(std::move(system), start, std::move(options)) {
  loop::validate(from.orbit.loop);
  _tracer->go_on_from(std::move(from));
}

Branch::~Branch() = default;
Branch::Branch(Branch&&) noexcept = default;
Branch& Branch::operator=(Branch&&) noexcept = default;

std::optional<Orbit> Branch::advance() {
  const core::LogStage stage(core::Stage::continuation);
  return _tracer->advance();
}
const std::optional<Ending>& Branch::ending() const { return _tracer->ending(); }
const Frontier& Branch::frontier() {
  _tracer->complete_frontier();
  return _tracer->frontier();
}
bool Branch::met_limit() const { return _tracer->met_limit(); }
const Frontier& Branch::restart_frontier() const { return _tracer->frontier(); }

Ending trace(std::shared_ptr<const systems::System> system, const Start& start, const Options& options,
             const Observer& observer) {
  const double unit = system->scales().time;
  Branch branch(std::move(system), start, options);
  while (const std::optional<Orbit> orbit = branch.advance())
    if (!observer(*orbit)) return {EndReason::stopped, fmt::format("T = {:.9g}", orbit->loop.period * unit)};
  return branch.ending().value();
}

corrector::Result orbit_at_period(const systems::System& system, const loop::Loop& near, const loop::Isotropy& isotropy,
                                  double period, const Options& options) {
  loop::Loop guess = near;
  guess.period = period;
  while (true) {
    const loss::Unknowns unknowns{loop::Subspace(guess.dimension, guess.cutoff, isotropy), {loss::Scalar::period()}};
    const Eigen::VectorXd pinned = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
    const std::vector<double> shift = time_shift_condition(guess, unknowns);
    Eigen::MatrixXd conditions(unknowns.size(), shift.empty() ? 1 : 2);
    conditions.col(0) = pinned;
    if (!shift.empty()) conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size());
    corrector::Result result = corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), conditions),
                                                  options.corrector, pinned);
    const int larger = loop::next_cutoff(guess.cutoff);
    const bool tail_is_short =
        loop::tail(result.loop) <= tail_limit(loop::rms_amplitude(result.loop),
                                              extent_of(result.loop.winding, loop::rms_size(result.loop)), options);
    const bool resolved = result.converged() ? tail_is_short : result.outcome != corrector::Outcome::under_resolved;
    if (resolved || larger > options.cutoff_to) return result;
    guess = loop::with_cutoff(guess, larger);
  }
}

}  // namespace orbweaver::continuation
