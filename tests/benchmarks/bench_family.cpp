// Whole families from small amplitude to T = 30, in the symmetric subspace, adaptive steps.
#include <benchmark/benchmark.h>

#include "family_orbit.hpp"

namespace orbweaver::benchmarks {

namespace {

void trace_family(benchmark::State& state, corrector::Method method, double period) {
  const FamilyStart begin = start_of(static_cast<Family>(state.range(0)));
  continuation::Options options;
  options.period_limit = period;
  options.corrector.method = method;
  int orbits = 0;
  int cutoff = 0;
  for (auto _ : state) {
    orbits = 0;
    const auto ending = continuation::trace(begin.system, begin.start, options, [&](const continuation::Orbit& o) {
      ++orbits;
      cutoff = o.loop.cutoff;
      return true;
    });
    if (ending.reason != continuation::EndReason::period_limit) state.SkipWithError(ending.text().c_str());
  }
  state.counters["orbits"] = orbits;
  state.counters["K_end"] = cutoff;
  state.counters["per_orbit"] =
      benchmark::Counter(orbits, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void family_to_T30(benchmark::State& s) { trace_family(s, corrector::Method::automatic, 30.0); }
void family_to_T12_by_nls(benchmark::State& s) { trace_family(s, corrector::Method::nls, 12.0); }
void family_to_T12(benchmark::State& s) { trace_family(s, corrector::Method::automatic, 12.0); }

BENCHMARK(family_to_T30)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(family_to_T12)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(family_to_T12_by_nls)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace orbweaver::benchmarks
