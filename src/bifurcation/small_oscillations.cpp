#include "orbweaver/bifurcation/small_oscillations.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/bifurcation/directions.hpp"

namespace orbweaver::bifurcation {

namespace {

// Modes of an oscillation at harmonic 1, scaled to |dz(s = 0)| = 1.
loop::Tangent at_unit_start(loop::Tangent tangent, std::size_t dimension) {
  std::vector<double>& modes = tangent.modes;
  double square = 0.0;
  for (std::size_t i = 0; i < dimension; ++i) square += modes[dimension + i] * modes[dimension + i];
  if (std::sqrt(square) > starts::still_at_start)
    for (double& v : modes) v /= std::sqrt(square);
  return tangent;
}

}  // namespace

std::vector<starts::NormalMode> small_oscillations(const systems::System& system, const starts::SweepResult& sweep,
                                                   int cutoff) {
  std::vector<starts::NormalMode> all = sweep.modes;
  for (const starts::DegenerateMode& mode : sweep.degenerate)
    for (const Direction& direction :
         equilibrium_directions(system, sweep.fixed_point, mode.period, mode.kernel, cutoff)) {
      const loop::Tangent tangent = at_unit_start(direction.tangent, sweep.fixed_point.size());
      all.push_back({mode.period, mode.grid_period, mode.residual, tangent, tangent, direction.isotropy});
    }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.period > b.period; });
  return all;
}

}  // namespace orbweaver::bifurcation
