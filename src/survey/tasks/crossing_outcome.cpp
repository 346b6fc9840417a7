#include "crossing_outcome.hpp"

#include <fmt/format.h>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"

namespace orbweaver::survey {

namespace {

using archive::CrossingKind;
using bifurcation::Event;

CrossingKind kind_of(const Event& event, int multiplicity) {
  if (event.kind == Event::Kind::fold_period) return CrossingKind::fold_period;
  if (event.kind == Event::Kind::fold_energy) return CrossingKind::fold_energy;
  if (event.kind == Event::Kind::fold_parameter) return CrossingKind::fold_parameter;
  if (!bifurcation::has_sector(event.function.kind)) {
    const std::string_view name = bifurcation::name_of(event.function.kind);
    const CrossingKind kind = archive::crossing_kind_of(name);
    if (kind == CrossingKind::unknown)
      throw core::MisuseError(fmt::format("the archive has no kind of crossings called {}", name));
    return kind;
  }
  if (multiplicity == 1) return CrossingKind::branch_point;
  return multiplicity == 2 ? CrossingKind::period_doubling : CrossingKind::subharmonic;
}

}  // namespace

bool is_in_sector(const Event& event) {
  return event.kind == Event::Kind::test_function && bifurcation::has_sector(event.function.kind);
}

void describe(const systems::System& system, const Event& event, const bifurcation::Crossing& crossing,
              const loop::Isotropy& isotropy, LocateOutcome& outcome) {
  const loop::Loop& loop = crossing.point.loop;
  const bifurcation::Sector& sector = event.function.sector;
  outcome.q = sector.q;
  outcome.j = sector.j;
  outcome.period = loop.period;
  outcome.energy = continuation::energy_of(system, loop);
  if (!loop.parameters.empty()) outcome.parameter = loop.parameters.front();
  outcome.fundamental_order = crossing.stability.fundamental_order;
  const bool by_sector = is_in_sector(event);
  outcome.multiplicity = by_sector ? sector.multiplicity(outcome.fundamental_order) : 1;
  outcome.kind = kind_of(event, outcome.multiplicity);
  outcome.residual = crossing.reading.value;
  outcome.place_error = crossing.place_error;
  outcome.test_value = archive::not_computed;
  if (by_sector) {  // the index itself, and how far it is from the sector's
    outcome.residual = bifurcation::index_deviation(system.structure(), crossing.stability, sector).value;
    outcome.test_value = sector.value(system.structure().symplectic) + outcome.residual;
  }
  outcome.kernel_singular_value = archive::not_computed;
  outcome.next_singular_value = archive::not_computed;
  outcome.kernel_dimension = by_sector ? -1 : 0;  // not computed yet
  outcome.state = loop::state_at(loop::in_standard_phase(system.structure(), loop, isotropy), 0.0);
}

}  // namespace orbweaver::survey
