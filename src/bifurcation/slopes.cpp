#include "orbweaver/bifurcation/slopes.hpp"

#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/system_at.hpp"

namespace orbweaver::bifurcation {

double period_slope(const continuation::CurvePoint& point) { return point.tangent.period(); }

double parameter_slope(const continuation::CurvePoint& point) {
  core::require(point.tangent.scalars.size() > 1, "a parameter folds where one moves");
  return point.tangent.scalars[1];
}

double energy_slope(const systems::System& system, const continuation::CurvePoint& point) {
  const std::vector<double> state = loop::state_at(point.loop, 0.0);
  const std::vector<double> change = loop::state_at(loop::perturbation(point.loop, point.tangent), 0.0);
  std::vector<double> gradient(state.size());
  loop::system_at(system, point.loop)->conserved_gradient(0, state, gradient);
  double slope = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) slope += gradient[i] * change[i];
  return slope;
}

double level_slope(const systems::System& system, const continuation::CurvePoint& point) {
  return system.family_scalars().free.empty() ? energy_slope(system, point) : parameter_slope(point);
}

}  // namespace orbweaver::bifurcation
