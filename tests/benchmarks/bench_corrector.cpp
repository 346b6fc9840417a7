// One correction against the cutoff K: an orbit padded to K, pushed off by a smooth perturbation, corrected at its
// period.
#include <benchmark/benchmark.h>

#include "family_orbit.hpp"
#include "memory.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::benchmarks {

namespace {

void correct_at(benchmark::State& state, corrector::Method method, bool symmetric, double period) {
  const FamilyOrbit& orbit = family_orbit(Family::in_phase, period);
  const int cutoff = loop::allowed_cutoff_at_least(static_cast<int>(state.range(0)));
  const loop::Isotropy isotropy = symmetric ? orbit.isotropy : loop::Isotropy{};
  const loss::Unknowns unknowns{loop::Subspace(orbit.loop.dimension, cutoff, isotropy), {loss::Scalar::period()}};
  loop::Loop guess = loop::with_cutoff(orbit.loop, cutoff);
  for (int k = 1; k <= 5; k += 2) {
    guess.cosine(k, 0) += 1e-3 / k;
    guess.sine(k, 2) -= 1e-3 / k;
  }
  Eigen::MatrixXd conditions = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
  if (!symmetric) {
    const std::vector<double> shift = unknowns.time_shift_direction(guess);
    conditions.conservativeResize(Eigen::NoChange, 2);
    conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size()).normalized();
  }
  const loss::Slice slice(unknowns.size(), conditions);
  corrector::Options options;
  options.method = method;
  corrector::Result result;
  for (auto _ : state) {
    result = corrector::correct(*orbit.system, guess, unknowns, slice, options);
    benchmark::DoNotOptimize(result);
  }
  if (!result.converged()) state.SkipWithError(result.detail.c_str());
  state.counters["MiB"] =
      peak_memory_of([&] { result = corrector::correct(*orbit.system, guess, unknowns, slice, options); });
  state.counters["K"] = cutoff;
  state.counters["unknowns"] = unknowns.size();
  state.counters["newton"] = result.iterations + 1;
  state.counters["inner_per_step"] = static_cast<double>(result.inner_iterations) / (result.iterations + 1);
  state.SetComplexityN(cutoff);
}

// A short orbit, which few harmonics resolve, so that the same one can be solved at every K.
void newton_krylov_symmetric_short(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, true, 8.25); }
void newton_krylov_full_short(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, false, 8.25); }
void default_symmetric_short(benchmark::State& s) { correct_at(s, corrector::Method::automatic, true, 8.25); }
void newton_krylov_symmetric(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, true, 12.0); }
void newton_krylov_full(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, false, 12.0); }
void newton_krylov_full_T20(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, false, 20.0); }
void newton_krylov_full_T30(benchmark::State& s) { correct_at(s, corrector::Method::newton_krylov, false, 30.0); }
void nls_symmetric(benchmark::State& s) { correct_at(s, corrector::Method::nls, true, 12.0); }
void nls_full(benchmark::State& s) { correct_at(s, corrector::Method::nls, false, 12.0); }

BENCHMARK(newton_krylov_symmetric_short)->RangeMultiplier(2)->Range(16, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_krylov_full_short)->RangeMultiplier(2)->Range(16, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(default_symmetric_short)->RangeMultiplier(2)->Range(16, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_krylov_symmetric)->RangeMultiplier(2)->Range(256, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_krylov_full)->RangeMultiplier(2)->Range(256, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_krylov_full_T20)->RangeMultiplier(4)->Range(512, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_krylov_full_T30)->RangeMultiplier(4)->Range(1024, 4096)->Unit(benchmark::kMillisecond);
BENCHMARK(nls_symmetric)->RangeMultiplier(2)->Range(256, 1024)->Unit(benchmark::kMillisecond);
BENCHMARK(nls_full)->Arg(256)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace orbweaver::benchmarks
