#include <numeric>

#include <benchmark/benchmark.h>

#include "family_orbit.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/equations/orbit_solver.hpp"

namespace orbweaver::benchmarks {

namespace {

/// The equations of a family at its orbit of period T, with a factor made there, and a prediction 1e-4 beside it.
struct Problem {
  explicit Problem(double period) : start(start_of(Family::in_phase)) {
    continuation::Options options;
    options.period_limit = period;
    continuation::Branch branch(start.system, start.start, options);
    while (branch.advance()) {
    }
    const continuation::Frontier& frontier = branch.frontier();
    const continuation::Resolution& resolution = frontier.problem.resolution;
    equations = std::make_unique<equations::Collocation>(
        *start.system, loop::fundamental_domain(start.system->structure(), start.start.isotropy),
        std::vector<double>(4, 0.0), std::vector<double>(4, 0.0), resolution.size, resolution.time_map);
    const std::vector<double>& orbit = frontier.points.back().values;
    std::vector<double> conditions(orbit.size(), 0.0);
    conditions[static_cast<std::size_t>(equations->period_at())] = 1.0;
    equations->set_conditions(conditions, orbit);
    equations->factor(orbit.data());
    prediction = orbit;
    for (double& v : prediction) v *= 1.0 + 1e-4;
    prediction[static_cast<std::size_t>(equations->period_at())] = orbit.back();
  }

  FamilyStart start;
  std::unique_ptr<equations::Collocation> equations;
  std::vector<double> prediction;
};

template <class Solver>
void solve(benchmark::State& state) {
  Problem problem(static_cast<double>(state.range(0)));
  Solver solver;
  int iterations = 0;
  for (auto _ : state) {
    std::vector<double> u = problem.prediction;
    const auto result = solver.solve(*problem.equations, u, true, {});
    if (!result.converged) state.SkipWithError("no convergence");
    iterations = result.iterations;
  }
  state.counters["cells"] = problem.equations->cells();
  state.counters["iterations"] = iterations;
}

void bare_orbit_solve(benchmark::State& state) { solve<equations::AndersonSolver>(state); }
void tao_orbit_solve(benchmark::State& state) { solve<equations::OrbitSolver>(state); }

void collocation_residual(benchmark::State& state) {
  const Problem problem(static_cast<double>(state.range(0)));
  std::vector<double> r(problem.prediction.size());
  for (auto _ : state) problem.equations->residual(problem.prediction.data(), r.data());
}

void collocation_precondition(benchmark::State& state) {
  const Problem problem(static_cast<double>(state.range(0)));
  std::vector<double> r = problem.prediction;
  for (auto _ : state) {
    r = problem.prediction;
    problem.equations->precondition(r.data());
  }
}

void collocation_factor(benchmark::State& state) {
  const Problem problem(static_cast<double>(state.range(0)));
  for (auto _ : state) problem.equations->factor(problem.prediction.data());
}

}  // namespace

BENCHMARK(bare_orbit_solve)->Arg(9)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(tao_orbit_solve)->Arg(9)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(collocation_residual)->Arg(9)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(collocation_precondition)->Arg(9)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(collocation_factor)->Arg(9)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace orbweaver::benchmarks
