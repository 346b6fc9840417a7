// Harmonics that the families' orbits need for a tail of 1e-12: evenly in time, under the best pulse, under the general
// map, and under the general map fitted once more to the loop under the first.
#include <array>

#include <fmt/format.h>

#include "family_orbit.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "support/best_pulse.hpp"

using namespace orbweaver;

int main() {
  const core::Session session;
  constexpr double tolerance = 1e-12;
  const std::array names{"In-Phase", "Out-Phase", "Down-Up", "Up-Down"};
  fmt::print("family T even kappa pulse general again\n");
  for (int n = 0; n < 4; ++n)
    for (const double period : {10.0, 15.0, 20.0, 25.0, 30.0}) {
      const benchmarks::FamilyOrbit& orbit = benchmarks::family_orbit(static_cast<benchmarks::Family>(n), period);
      const loop::TimeMapFit pulse = test::best_pulse(orbit.loop, tolerance);
      const loop::TimeMapFit general = loop::fit_general(orbit.loop, orbit.isotropy, tolerance);
      const loop::Loop mapped = loop::with_time_map(orbit.loop, general.map, general.harmonics + 20);
      fmt::print("{} {} {} {:.2f} {} {} {}\n", names[static_cast<std::size_t>(n)], period,
                 loop::harmonics_above(orbit.loop, tolerance), pulse.map.kappa, pulse.harmonics, general.harmonics,
                 loop::fit_general(mapped, orbit.isotropy, tolerance).harmonics);
    }
}
