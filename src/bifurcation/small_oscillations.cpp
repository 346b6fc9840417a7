#include "orbweaver/bifurcation/small_oscillations.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/core/error.hpp"

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

int families_of(const systems::System& system, const starts::SweepResult& sweep, const starts::Oscillation& oscillation,
                int cutoff) {
  if (oscillation.multiplicity() == 1) return 1;
  try {
    return static_cast<int>(
        equilibrium_directions(system, sweep.fixed_point, oscillation.period, oscillation.kernel, cutoff).size());
  } catch (const core::NumericalError&) {
    return oscillation.multiplicity();  // a place each, of families that are not asked for
  }
}

}  // namespace

SmallOscillations small_oscillations(const systems::System& system, const starts::SweepResult& sweep, int cutoff) {
  SmallOscillations all;
  for (const starts::NormalMode& mode : sweep.modes) all.families.push_back({mode, 0});
  for (const starts::DegenerateMode& mode : sweep.degenerate)
    for (const Direction& direction :
         equilibrium_directions(system, sweep.fixed_point, mode.period, mode.kernel, cutoff)) {
      const loop::Tangent tangent = at_unit_start(direction.tangent, sweep.fixed_point.size());
      all.families.push_back({{mode.period, mode.grid_period, mode.residual, tangent, tangent, direction.isotropy}, 0});
    }
  std::stable_sort(all.families.begin(), all.families.end(),
                   [](const auto& a, const auto& b) { return a.mode.period > b.mode.period; });
  for (const starts::Oscillation& oscillation : sweep.left_out)
    all.left_out.push_back({oscillation.period, 0, families_of(system, sweep, oscillation, cutoff)});
  for (const starts::UndecidedEigenvalues& eigenvalues : sweep.linear.undecided)
    if (std::isfinite(eigenvalues.period())) all.left_out.push_back({eigenvalues.period(), 0, eigenvalues.count, true});
  std::stable_sort(all.left_out.begin(), all.left_out.end(),
                   [](const LeftOut& a, const LeftOut& b) { return a.period > b.period; });
  auto family = all.families.begin();
  auto left_out = all.left_out.begin();
  while (family != all.families.end() || left_out != all.left_out.end())
    if (left_out == all.left_out.end() || (family != all.families.end() && family->mode.period > left_out->period)) {
      (family++)->place = all.count++;
    } else {
      left_out->place = all.count;
      all.count += (left_out++)->families;
    }
  return all;
}

}  // namespace orbweaver::bifurcation
