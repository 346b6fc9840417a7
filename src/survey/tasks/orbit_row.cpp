#include "orbit_row.hpp"

#include <cmath>

#include <fmt/format.h>

#include "certified.hpp"
#include "orbweaver/bifurcation/stability_of_orbit.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/left_open.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/spectrum/log_volume.hpp"
#include "stability_columns.hpp"

namespace orbweaver::survey {

std::string not_told_apart(const systems::System& system, const loop::Loop& orbit, const loop::Loop* neighbour,
                           const loop::Isotropy& isotropy, core::Team* team) {
  const std::optional<spectrum::Stability> stability = stability_of(system, orbit, isotropy, team);
  if (stability && !bifurcation::is_isolated(*stability)) return "an index is 2 to rounding";
  if (neighbour == nullptr) return {};
  return nearer_than_rounding(system, orbit, *neighbour, isotropy);
}

std::string nearer_than_rounding(const systems::System& system, const loop::Loop& orbit, const loop::Loop& neighbour,
                                 const loop::Isotropy& isotropy) {
  const double apart = continuation::arclength_between(neighbour, orbit);
  const double open = continuation::left_open_by_rounding(system, orbit, isotropy).across;
  if (!(open > apart)) return {};
  return fmt::format("rounding leaves an orbit open by {:.2g}, and its neighbour is {:.2g} away", open, apart);
}

std::optional<spectrum::Stability> stability_of(const systems::System& system, const loop::Loop& loop,
                                                const loop::Isotropy& isotropy, core::Team* team) {
  try {
    return bifurcation::stability_of(system, loop, isotropy, team);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

namespace {

/// Of the loop that is stored, on the loss's grid. A branch by collocation has it from its own nodes, which between
/// them miss up to a third beside a collision.
double residual_of(const systems::System& system, const loop::Loop& stored, double otherwise) {
  try {
    return std::sqrt(loss::Linearization(system, stored, loss::Linearization::Order::residual).loss());
  } catch (const core::NumericalError&) {  // not finite between the branch's nodes
    return otherwise;
  }
}

}  // namespace

double log_volume_of(const systems::System& system, const loop::Loop& loop) {
  try {
    return spectrum::log_volume(system, loop);
  } catch (const core::NumericalError&) {
    return archive::not_computed;
  }
}

archive::OrbitRecord orbit_row(const systems::System& system, const std::string& family,
                               const continuation::Orbit& orbit, const loop::Loop& stored,
                               const std::optional<spectrum::Stability>& stability, certificate::Certifier* certifier) {
  archive::OrbitRecord row;
  row.family_key = family;
  row.step = orbit.step;
  const systems::Scales& units = system.scales();
  const loop::Loop in_units = loop::in_units(stored, units);
  row.arclength = orbit.arclength;
  row.period = in_units.period;
  row.energy = orbit.energy * units.energy();
  row.action = orbit.action * units.action();
  if (!in_units.parameters.empty()) row.parameter = in_units.parameters.front();
  row.cutoff = stored.cutoff;
  row.loss_rms = residual_of(system, stored, orbit.loss_rms);
  row.off_branch_eigenvalue = orbit.off_branch_eigenvalue;
  row.tail = loop::tail(stored);
  row.state = loop::state_at(in_units, 0.0);
  row.modes = in_units.modes;
  row.time_map = loop::to_numbers(stored.time_map);
  for (const int angle : system.structure().angles)
    row.winding.push_back(orbit.loop.winding[static_cast<std::size_t>(angle)]);
  if (!system.structure().symplectic) row.log_volume = log_volume_of(system, stored);
  set_stability(system.structure(), stability, row);
  if (certifier != nullptr) {
    const bool is_complex = stability && row.stability.size() != stability->full.size();
    const certificate::Evidence evidence =
        evidence_of(stored, row.loss_rms, row.stability, is_complex, row.stability_error);
    static_cast<archive::CertificateRecord&>(row) = record_of((*certifier)(stored, evidence.growth), evidence);
  }
  return row;
}

}  // namespace orbweaver::survey
