// Floquet multipliers with their error bounds, of in-phase and out-phase orbits against the period.
#include <benchmark/benchmark.h>

#include "family_orbit.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "support/relative_error.hpp"

namespace orbweaver::benchmarks {

namespace {

/// The loop under the map of one parameter that needs the fewest harmonics for a tail of 1e-11.
loop::Loop mapped(const loop::Loop& loop) {
  loop::Loop best = loop;
  for (const double kappa : {1.5, 2.0, 3.0, 5.0, 8.0, 12.0}) {
    for (int cutoff = 22; cutoff < best.cutoff; cutoff = loop::next_cutoff(cutoff)) {
      const loop::Loop candidate = loop::with_time_map(loop, {kappa, {}}, cutoff);
      if (loop::tail(candidate) < 1e-11) best = candidate;
    }
  }
  return best;
}

void multipliers(benchmark::State& state, Family family, bool symmetric, bool map) {
  const FamilyOrbit& orbit = family_orbit(family, static_cast<double>(state.range(0)));
  const loop::Loop loop = map ? mapped(orbit.loop) : orbit.loop;
  const loop::Isotropy isotropy = symmetric ? orbit.isotropy : loop::Isotropy{};
  spectrum::Stability stability;
  for (auto _ : state) {
    stability = spectrum::floquet(*orbit.system, loop, isotropy);
    benchmark::DoNotOptimize(stability);
  }
  state.counters["K"] = loop.cutoff;
  state.counters["kappa"] = loop.time_map.kappa;
  state.counters["k"] = stability.full[0].real();
  state.counters["bound"] = test::relative_error(stability);
}

void multipliers_full(benchmark::State& s) { multipliers(s, Family::in_phase, false, false); }
void multipliers_symmetric(benchmark::State& s) { multipliers(s, Family::in_phase, true, false); }
void multipliers_full_mapped(benchmark::State& s) { multipliers(s, Family::in_phase, false, true); }
void multipliers_symmetric_mapped(benchmark::State& s) { multipliers(s, Family::in_phase, true, true); }
void multipliers_full_out_phase(benchmark::State& s) { multipliers(s, Family::out_phase, false, false); }

BENCHMARK(multipliers_full)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_symmetric)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_full_mapped)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_symmetric_mapped)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK(multipliers_full_out_phase)->Arg(10)->Arg(15)->Arg(20)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace orbweaver::benchmarks
