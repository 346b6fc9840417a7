#include "solvers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "auto_program.hpp"
#include "correction.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/method.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/refine/shoot.hpp"
#include "reach.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

using corrector::Method;

const std::vector<double> tolerances{1e-4, 1e-7, 1e-10, 1e-13};
const std::vector<double> quick_tolerances{1e-4, 1e-10};
/// Iterations that show how long one of a first-order method takes, and seconds after which one is given up.
constexpr int trial_iterations = 50;
constexpr double patience = 4.0;
constexpr double quick_patience = 0.3;
constexpr int most_iterations = 200000;  // the method's own bound
/// Dense matrices of more unknowns take seconds a Newton step.
constexpr int most_dense = 2000;
constexpr int single = 1;  // segments

/// Mesh intervals of AUTO that go with a tolerance: twice as many gain some 2.4 digits (order 8).
int intervals_for(double tolerance) {
  constexpr double at_first = 20.0;  // to 1e-4
  constexpr double digits_a_doubling = 2.4;
  return static_cast<int>(std::lround(at_first * std::exp2((-std::log10(tolerance) - 4.0) / digits_a_doubling / 1.2)));
}

struct Attempt {
  double tolerance = std::numeric_limits<double>::quiet_NaN();
  double seconds = 0.0;
  double error = std::numeric_limits<double>::quiet_NaN();
  int unknowns = 0;
  int iterations = 0;
  std::string end;
  bool is_final = false;  ///< tighter tolerances bring no more
};

struct Solver {
  std::string name;
  std::string obstacle;  ///< why it does not apply
  std::function<Attempt(double tolerance)> run;
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
    return Attempt{tolerance,
                   timing.seconds,
                   truth.error_of(result.loop),
                   correction.unknowns(),
                   result.iterations,
                   std::string(corrector::name_of(result.outcome)),
                   result.outcome == corrector::Outcome::iteration_limit};
  };
  return solver;
}

Solver collocation(const Setting& setting, const TrueOrbit& truth, const Directed& guess, const loop::Loop& orbit) {
  Solver solver{"collocation", obstacle_to_collocation(setting), {}};
  solver.run = [&](double tolerance) {
    CollocationResult result;
    const int cells = cells_for(setting, guess.loop.cutoff);
    const Timing timing =
        timing_of([&] { result = by_collocation(setting, guess, orbit, cells, tolerance); }, setting.budget());
    return Attempt{tolerance,       timing.seconds,    truth.error_of(result.loop),
                   result.unknowns, result.iterations, result.converged ? "converged" : result.reason};
  };
  return solver;
}

Solver shooting(const Setting& setting, const TrueOrbit& truth, const Directed& guess, int segments) {
  Solver solver{segments == single ? "single shooting" : "multiple shooting", {}, {}};
  solver.run = [&, segments](double) {  // to rounding, whatever the tolerance
    Attempt attempt;
    attempt.is_final = true;
    try {
      const refine::Guess start = refine::guess_of(setting.plain(), *setting.system(), guess.loop, setting.isotropy());
      refine::ShotOrbit orbit;
      const Timing timing = timing_of([&] { orbit = refine::shoot(start, truth.held(), segments); }, setting.budget());
      attempt.seconds = timing.seconds;
      attempt.error = truth.error_of(orbit);
      attempt.unknowns = static_cast<int>(orbit.states.size()) * guess.loop.dimension + 1;
      attempt.end = "converged";
    } catch (const core::NumericalError&) {
      attempt.end = "Newton's method finds no orbit";
    }
    return attempt;
  };
  return solver;
}

Solver auto07p(const Setting& setting, const TrueOrbit& truth, const Directed& guess) {
  Solver solver{"AUTO-07p", AutoProgram::obstacle(truth), {}};
  if (!solver.obstacle.empty()) return solver;
  const auto program = std::make_shared<AutoProgram>(setting, guess);
  solver.run = [&setting, &truth, program](double tolerance) {
    Attempt attempt;
    attempt.tolerance = tolerance;
    const int intervals = intervals_for(tolerance);
    attempt.unknowns = intervals * AutoProgram::points * setting.system()->dimension();
    try {
      program->prepare(intervals, tolerance);
      bool ended_well = false;
      const Timing timing = timing_of([&] { ended_well = program->run(); }, setting.budget());
      attempt.seconds = timing.seconds;
      attempt.error = truth.error_at_its_period(program->found());
      attempt.end = ended_well ? "converged" : "failed";
    } catch (const core::NumericalError& error) {
      attempt.end = error.what();
    }
    return attempt;
  };
  return solver;
}

std::vector<Solver> solvers_for(const Setting& setting, const TrueOrbit& truth, const Correction& correction,
                                const Directed& guess, const loop::Loop& orbit) {
  std::vector<Solver> solvers{collocation(setting, truth, guess, orbit)};
  for (const Method method : {Method::newton_krylov, Method::nls, Method::ntr, Method::brgn, Method::lmvm,
                              Method::rprop_extrapolated, Method::rprop})
    solvers.push_back(by_corrector(setting, truth, correction, method));
  solvers.push_back(shooting(setting, truth, guess, single));
  solvers.push_back(shooting(setting, truth, guess, 0));
  solvers.push_back(auto07p(setting, truth, guess));
  return solvers;
}

void measure_solvers(const Setting& setting, const Take& take) {
  Table all{
      "solvers",
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
  for (Column& column : Reach::columns()) reach.columns.push_back(std::move(column));
  reach.columns.push_back({"end"});
  const double unit = setting.system()->scales().time;
  for (const Probe& probe : setting.probes()) {
    const TrueOrbit& truth = setting.truth_of(probe);
    const Directed guess = pushed_off(setting, probe);
    const Correction correction(setting, guess, setting.isotropy());
    for (const Solver& solver : solvers_for(setting, truth, correction, guess, probe.orbit.loop)) {
      Reach reached;
      Attempt last;
      if (solver.obstacle.empty())
        for (const double tolerance : setting.quick() ? quick_tolerances : tolerances) {
          last = solver.run(tolerance);
          all.rows.push_back({probe.name, probe.orbit.loop.period * unit, solver.name, last.tolerance, last.unknowns,
                              last.iterations, last.seconds, last.error, last.end});
          reached.add(last.seconds, last.error);
          if (last.is_final) break;
        }
      std::vector<Cell> row{probe.name, solver.name, last.unknowns > 0 ? Cell(last.unknowns) : Cell()};
      for (Cell& cell : reached.cells()) row.push_back(std::move(cell));
      row.emplace_back(solver.obstacle.empty() ? last.end : solver.obstacle);
      reach.rows.push_back(std::move(row));
    }
  }
  reach.remarks.emplace_back(fmt::format(
      "from the orbit pushed off by {:.0e}, at the branch's own K and time map, in the subspace of its symmetries; "
      "first-order methods end after {} s",
      setting.branch_options().prediction_error, setting.quick() ? quick_patience : patience));
  reach.remarks.emplace_back(
      "AUTO-07p: a process for each orbit, its start in it; whole loop, four Gauss points a mesh interval");
  take(all);
  take(reach);
}

}  // namespace

const Ladder solvers_ladder{"solvers", "the solvers on the same orbits to the same true error", measure_solvers};

}  // namespace orbweaver::cost
