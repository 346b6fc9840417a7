#include "equilibria.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/starts/equilibrium_curve.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "tasks/payload/work.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

namespace {

using starts::EquilibriumKind;

const char* name_of(EquilibriumKind kind) {
  switch (kind) {
    case EquilibriumKind::hopf: return "hopf";
    case EquilibriumKind::fold: return "fold-parameter";
    case EquilibriumKind::came_back: return "return";
    case EquilibriumKind::branch_point: return "branch-point";
    case EquilibriumKind::regular: break;
  }
  return "equilibrium";
}

/// Whether a point of a curve is an equilibrium of the grid, angles modulo 2 pi.
bool is_at(const systems::System& system, std::vector<double> state, const std::vector<double>& point) {
  for (const int angle : system.structure().angles) {
    const auto i = static_cast<std::size_t>(angle);
    state[i] = point[i] + std::remainder(state[i] - point[i], 2.0 * std::numbers::pi);
  }
  return starts::is_same_fixed_point(state, point);
}

archive::EquilibriumRecord row_of(int index, const EquilibriumPlace& place, const Units& units) {
  archive::EquilibriumRecord row;
  row.equilibrium = index;
  row.step = place.step;
  row.arclength = place.arclength;
  row.kind = name_of(place.kind);
  if (units.in_parameter()) row.parameter = place.parameter * units.parameter(0);
  row.state = place.state;
  for (std::size_t i = 0; i < row.state.size(); ++i) row.state[i] *= units.coordinate(i);
  row.energy = place.energy * units.energy();
  row.stability = starts::to_text(place.stability);
  row.eigenvalues = place.eigenvalues;
  for (double& value : row.eigenvalues) value /= units.time;
  row.periods = place.periods;
  for (double& period : row.periods) period *= units.time;
  row.multiplicity.assign(place.multiplicity.begin(), place.multiplicity.end());
  row.note = place.note;
  return row;
}

/// The first equilibrium before `sweep` whose curve passes its own, where the parameter has the scene's value again.
std::optional<int> curve_through(const systems::System& system, const SweepOutcome& sweep,
                                 const std::vector<SweepOutcome>& before) {
  for (const SweepOutcome& other : before)
    for (const EquilibriumPlace& place : other.equilibria)
      if (place.kind == EquilibriumKind::came_back && is_at(system, place.state, sweep.point)) return other.index;
  return std::nullopt;
}

}  // namespace

void add_equilibria(const systems::System& system, const SweepsEnded& sweeps, archive::Records& tables) {
  const Units units(system);
  std::vector<SweepOutcome> before;
  for (const auto& [key, ended] : sweeps) {
    const SweepWork work = unpack_sweep_work(ended.first.payload);
    if (!work.given.empty()) continue;  // an orbit that the scene gives
    if (ended.second.failed) {
      archive::EquilibriumRecord& row = tables.equilibria.emplace_back();
      row.equilibrium = work.index;
      row.kind = name_of(EquilibriumKind::regular);
      if (units.in_parameter()) row.parameter = system.parameters().at(units.parameter_name);
      row.state = work.point;
      for (std::size_t i = 0; i < row.state.size(); ++i) row.state[i] *= units.coordinate(i);
      continue;
    }
    SweepOutcome sweep = unpack_sweep_outcome(ended.second.payload);
    const std::optional<int> known = curve_through(system, sweep, before);
    for (const EquilibriumPlace& place : sweep.equilibria) {
      if (known && place.step != 0) continue;
      archive::EquilibriumRecord& row = tables.equilibria.emplace_back(row_of(sweep.index, place, units));
      if (known) row.note = fmt::format("on the curve of {}", equilibrium_name(*known));
    }
    if (!known) before.push_back(std::move(sweep));
  }
}

}  // namespace orbweaver::survey
