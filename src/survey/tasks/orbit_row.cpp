#include "orbit_row.hpp"

#include "certified.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "stability_columns.hpp"

namespace orbweaver::survey {

std::optional<spectrum::Stability> stability_of(const systems::System& system, const loop::Loop& loop,
                                                const loop::Isotropy& isotropy, core::Team* team) {
  try {
    spectrum::FloquetOptions options;
    options.team = team;
    return spectrum::floquet(system, loop, isotropy, options);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

archive::OrbitRecord orbit_row(const systems::System& system, const std::string& family,
                               const continuation::Orbit& orbit, const loop::Isotropy& isotropy,
                               const std::optional<spectrum::Stability>& stability, certificate::Certifier* certifier) {
  const loop::Loop stored = loop::in_standard_phase(system.structure(), orbit.loop, isotropy);
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
  row.loss_rms = orbit.loss_rms;
  row.off_branch_eigenvalue = orbit.off_branch_eigenvalue;
  row.tail = loop::tail(stored);
  row.state = loop::state_at(in_units, 0.0);
  row.modes = in_units.modes;
  row.time_map = loop::to_numbers(stored.time_map);
  for (const int angle : system.structure().angles)
    row.winding.push_back(orbit.loop.winding[static_cast<std::size_t>(angle)]);
  set_stability(system.structure(), stability, row);
  if (certifier != nullptr) {
    const bool is_complex = stability && row.stability.size() != stability->full.size();
    static_cast<archive::CertificateRecord&>(row) = record_of(
        (*certifier)(stored), evidence_of(stored, row.loss_rms, row.stability, is_complex, row.stability_error));
  }
  return row;
}

}  // namespace orbweaver::survey
