#include "solvers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "correction.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/method.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/refine/shoot.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

using corrector::Method;

const std::vector<double> tolerances{1e-4, 1e-7, 1e-10, 1e-13};
const std::vector<double> quick_tolerances{1e-4, 1e-10};
/// The true errors at which solvers are compared.
const std::vector<double> targets{1e-3, 1e-6, 1e-9, 1e-12};
/// Iterations that show how long one of a first-order method takes, and seconds after which one is given up.
constexpr int trial_iterations = 50;
constexpr double patience = 4.0;
constexpr double quick_patience = 0.3;
constexpr int most_iterations = 200000;  // the method's own bound
/// Dense matrices of more unknowns take seconds a Newton step.
constexpr int most_dense = 2000;
constexpr int single = 1;  // segments

struct Attempt {
  double tolerance = std::numeric_limits<double>::quiet_NaN();
  double seconds = 0.0;
  double error = std::numeric_limits<double>::quiet_NaN();
  int unknowns = 0;
  int iterations = 0;
  std::string end;
  bool converged = false;
};

struct Solver {
  std::string name;
  std::string obstacle;  ///< why it does not apply
  std::function<Attempt(double tolerance)> run;
  bool has_tolerance = true;
};

/// As many iterations as fit into the patience.
int bound_on_iterations(const Setting& setting, const Correction& correction, Method method) {
  if (corrector::is_second_order(method)) return 0;
  const double seconds = seconds_of(
      [&] { static_cast<void>(correction.by(method, std::numeric_limits<double>::min(), trial_iterations)); });
  const double limit = setting.quick() ? quick_patience : patience;
  return std::clamp(static_cast<int>(limit / seconds * trial_iterations), trial_iterations, most_iterations);
}

Solver by_corrector(const Setting& setting, const TrueOrbit& truth, const Correction& correction, Method method) {
  Solver solver{std::string(corrector::name_of(method)), {}, {}};
  const bool dense = method != Method::newton_krylov && corrector::is_second_order(method);
  if (dense && correction.unknowns() > most_dense) {
    solver.obstacle = fmt::format("{} unknowns are too many for dense matrices", correction.unknowns());
    return solver;
  }
  solver.run = [&, method](double tolerance) {
    const int bound = bound_on_iterations(setting, correction, method);
    corrector::Result result;
    const Timing timing = timing_of([&] { result = correction.by(method, tolerance, bound); }, setting.budget());
    return Attempt{tolerance,         timing.seconds,        truth.error_of(result.loop),
                   correction.unknowns(), result.iterations, std::string(corrector::name_of(result.outcome)),
                   result.converged()};
  };
  return solver;
}

Solver collocation(const Setting& setting, const TrueOrbit& truth, const Directed& guess) {
  Solver solver{"collocation", obstacle_to_collocation(setting), {}};
  solver.run = [&](double tolerance) {
    CollocationResult result;
    const int cells = cells_for(setting, guess.loop.cutoff);
    const Timing timing = timing_of([&] { result = by_collocation(setting, guess, cells, tolerance); }, setting.budget());
    return Attempt{tolerance,         timing.seconds,    truth.error_of(result.loop),
                   result.unknowns, result.iterations, result.converged ? "converged" : result.reason,
                   result.converged};
  };
  return solver;
}

Solver shooting(const Setting& setting, const TrueOrbit& truth, const Directed& guess, int segments) {
  Solver solver{segments == single ? "single shooting" : "multiple shooting", {}, {}, false};
  solver.run = [&, segments](double tolerance) {
    Attempt attempt;
    attempt.tolerance = tolerance;
    try {
      const refine::Guess start = refine::guess_of(setting.plain(), *setting.system(), guess.loop, setting.isotropy());
      refine::ShotOrbit orbit;
      const Timing timing = timing_of([&] { orbit = refine::shoot(start, truth.held(), segments); }, setting.budget());
      attempt.seconds = timing.seconds;
      attempt.error = truth.error_of(orbit);
      attempt.unknowns = static_cast<int>(orbit.states.size()) * guess.loop.dimension + 1;
      attempt.converged = true;
      attempt.end = "converged";
    } catch (const core::NumericalError&) {
      attempt.end = "Newton's method finds no orbit";
    }
    return attempt;
  };
  return solver;
}

std::vector<Solver> solvers_for(const Setting& setting, const TrueOrbit& truth, const Correction& correction,
                                const Directed& guess) {
  std::vector<Solver> solvers{collocation(setting, truth, guess)};
  for (const Method method : {Method::newton_krylov, Method::nls, Method::ntr, Method::brgn, Method::lmvm,
                              Method::rprop_extrapolated, Method::rprop})
    solvers.push_back(by_corrector(setting, truth, correction, method));
  solvers.push_back(shooting(setting, truth, guess, single));
  solvers.push_back(shooting(setting, truth, guess, 0));
  return solvers;
}

void measure(const Setting& setting, const Take& take) {
  Table all{"solvers",
            fmt::format("{}: solvers from one guess, error against time", setting.family()),
            {{"orbit"}, {"T"}, {"solver"}, {"tolerance"}, {"unknowns"}, {"iterations"}, {"time", "s"}, {"error"}, {"end"}},
            {},
            {},
            Plot{6, 7, {2}, 0},
            false};
  Table reach{"solvers_reach",
              fmt::format("{}: seconds in which solvers reach a true error, from one guess", setting.family()),
              {{"orbit"}, {"solver"}, {"unknowns"}},
              {},
              {}};
  for (const double target : targets) reach.columns.push_back({fmt::format("to {:.0e}", target), "s"});
  reach.columns.push_back({"best error"});
  reach.columns.push_back({"end"});
  const double unit = setting.system()->scales().time;
  for (const Probe& probe : setting.probes()) {
    const TrueOrbit& truth = setting.truth_of(probe);
    const Directed guess = pushed_off(setting, probe);
    const Correction correction(setting, guess, setting.isotropy());
    for (const Solver& solver : solvers_for(setting, truth, correction, guess)) {
      if (!solver.obstacle.empty()) {
        reach.rows.push_back({probe.name, solver.name, {}, {}, {}, {}, {}, {}, solver.obstacle});
        continue;
      }
      std::vector<double> least(targets.size(), std::numeric_limits<double>::quiet_NaN());
      double best = std::numeric_limits<double>::quiet_NaN();
      Attempt last;
      for (const double tolerance : setting.quick() ? quick_tolerances : tolerances) {
        last = solver.run(tolerance);
        if (!solver.has_tolerance) last.tolerance = std::numeric_limits<double>::quiet_NaN();
        all.rows.push_back({probe.name, probe.orbit.loop.period * unit, solver.name, last.tolerance, last.unknowns,
                            last.iterations, last.seconds, last.error, last.end});
        best = std::fmin(best, last.error);
        for (std::size_t n = 0; n < targets.size(); ++n)
          if (last.error <= targets[n]) least[n] = std::fmin(least[n], last.seconds);
        if (!last.converged || !solver.has_tolerance) break;
      }
      std::vector<Cell> row{probe.name, solver.name, last.unknowns};
      for (const double seconds : least) row.emplace_back(seconds);
      row.emplace_back(best);
      row.emplace_back(last.converged ? last.end : fmt::format("{} at tolerance {:.0e}", last.end, last.tolerance));
      reach.rows.push_back(std::move(row));
    }
  }
  reach.remarks.emplace_back(fmt::format(
      "from the orbit pushed off by {:.0e}, at the branch's own K and time map, in the subspace of its symmetries; "
      "first-order methods end after {} s",
      setting.branch_options().prediction_error, setting.quick() ? quick_patience : patience));
  reach.remarks.emplace_back(
      "AUTO-07p is measured on the double pendulum by the target bench_auto (docs/performance.md), not here");
  take(all);
  take(reach);
}

}  // namespace

const Ladder solvers_ladder{"solvers", "the solvers on the same orbits to the same true error", measure};

}  // namespace orbweaver::cost
