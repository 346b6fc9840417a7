// Smallest eigenpairs and singular triplets of assembled matrices, and the assembly itself, against K.
#include <benchmark/benchmark.h>

#include "family_orbit.hpp"
#include "orbweaver/loss/matrices.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/spectrum/singular_triplets.hpp"

namespace orbweaver::benchmarks {

namespace {

struct Problem {
  loss::Linearization linearization;
  loss::Unknowns unknowns;
};

Problem problem_at(int k) {
  const FamilyOrbit& orbit = family_orbit(Family::in_phase, 9.0);
  const loop::Loop loop = loop::with_cutoff(orbit.loop, loop::allowed_cutoff_at_least(k));
  return {loss::Linearization(*orbit.system, loop, loss::Linearization::Order::jacobian),
          {loop::Subspace(loop.dimension, loop.cutoff, orbit.isotropy), true}};
}

void assemble_hessian(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(loss::assemble_hessian(p.linearization, p.unknowns, loss::Curvature::gauss_newton));
  state.counters["unknowns"] = p.unknowns.size();
}

void two_smallest_eigenpairs(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  const core::Handle<Mat> h = loss::assemble_hessian(p.linearization, p.unknowns, loss::Curvature::gauss_newton);
  for (auto _ : state) benchmark::DoNotOptimize(spectrum::smallest_eigenpairs(h, {.count = 2}));
  state.counters["unknowns"] = p.unknowns.size();
}

void two_smallest_singular_triplets(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  const core::Handle<Mat> j = loss::assemble_jacobian(p.linearization, p.unknowns);
  for (auto _ : state) benchmark::DoNotOptimize(spectrum::smallest_singular_triplets(j, 2));
  state.counters["unknowns"] = p.unknowns.size();
}

BENCHMARK(assemble_hessian)->RangeMultiplier(2)->Range(64, 1024)->Unit(benchmark::kMicrosecond);
BENCHMARK(two_smallest_eigenpairs)->RangeMultiplier(2)->Range(16, 512)->Unit(benchmark::kMicrosecond);
BENCHMARK(two_smallest_singular_triplets)->RangeMultiplier(2)->Range(16, 128)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace orbweaver::benchmarks
