// Floquet multipliers with their error bounds, of in-phase and out-phase orbits against the period.
#include <benchmark/benchmark.h>

#include "family_orbit.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::benchmarks {

namespace {

void multipliers(benchmark::State& state, Family family, bool symmetric, double kappa) {
  const FamilyOrbit& orbit = family_orbit(family, static_cast<double>(state.range(0)));
  loop::Loop loop = orbit.loop;
  if (kappa != 1.0) {  // the least cutoff that keeps the tail
    const loop::TimeMap map{kappa, {}};
    int cutoff = 22;
    while (cutoff < loop.cutoff && loop::tail(loop::with_time_map(orbit.loop, map, cutoff)) > 1e-11)
      cutoff = loop::next_cutoff(cutoff);
    loop = loop::with_time_map(orbit.loop, map, cutoff);
  }
  const loop::Isotropy isotropy = symmetric ? orbit.isotropy : loop::Isotropy{};
  spectrum::Stability stability;
  for (auto _ : state) {
    stability = spectrum::floquet(*orbit.system, loop, isotropy);
    benchmark::DoNotOptimize(stability);
  }
  state.counters["K"] = loop.cutoff;
  state.counters["k"] = stability.full[0].real();
  state.counters["bound"] = stability.relative_error();
}

void multipliers_full(benchmark::State& s) { multipliers(s, Family::in_phase, false, 1.0); }
void multipliers_symmetric(benchmark::State& s) { multipliers(s, Family::in_phase, true, 1.0); }
void multipliers_full_mapped(benchmark::State& s) { multipliers(s, Family::in_phase, false, 3.0); }
void multipliers_symmetric_mapped(benchmark::State& s) { multipliers(s, Family::in_phase, true, 3.0); }
void multipliers_full_out_phase(benchmark::State& s) { multipliers(s, Family::out_phase, false, 1.0); }

BENCHMARK(multipliers_full)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_symmetric)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_full_mapped)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_symmetric_mapped)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_full_out_phase)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace orbweaver::benchmarks
