#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/archive/schema/schema.hpp"
#include "survey/atlas.hpp"

namespace orbweaver::test {

inline std::vector<double> row_of(const Atlas& atlas, const char* column, std::size_t row, std::size_t width) {
  const auto first = atlas.orbits().reals(column).begin() + static_cast<std::ptrdiff_t>(row * width);
  return {first, first + static_cast<std::ptrdiff_t>(width)};
}

/// The key of a base family at the first equilibrium, or its twin's at the second one.
inline std::string key_of(std::int64_t row, int equilibrium = 0) {
  return row < 0 ? "" : fmt::format("{:04}.{:04}", equilibrium, row);
}

/// An atlas as it was handed over: families have the keys "0000.ROW".
inline archive::Records records_of(const Atlas& atlas) {
  archive::Records records;
  const archive::Table& families = atlas.families();
  for (std::size_t row = 0; row < families.rows(); ++row) {
    archive::FamilyRecord family;
    family.key = key_of(static_cast<std::int64_t>(row));
    family.name = families.texts("name")[row];
    family.parent_key = key_of(families.integers("parent")[row]);
    family.crossing = static_cast<int>(families.integers("crossing")[row]);
    family.multiplicity = static_cast<int>(families.integers("multiplicity")[row]);
    family.isotropy = families.texts("isotropy")[row];
    family.end_reason = families.texts("end_reason")[row];
    family.birth_arclength = families.reals("birth_arclength")[row];
    records.families.push_back(family);
  }
  const archive::Table& crossings = atlas.crossings();
  for (std::size_t row = 0; row < crossings.rows(); ++row) {
    archive::CrossingRecord crossing;
    crossing.family_key = key_of(crossings.integers("family")[row]);
    crossing.arclength = crossings.reals("arclength")[row];
    crossing.period = crossings.reals("period")[row];
    crossing.energy = crossings.reals("energy")[row];
    crossing.parameter = crossings.reals("parameter")[row];
    crossing.kind = atlas.crossing_kinds()[row];
    crossing.multiplicity = static_cast<int>(crossings.integers("multiplicity")[row]);
    crossing.kernel_dimension = static_cast<int>(crossings.integers("kernel_dimension")[row]);
    crossing.sector_j = static_cast<int>(crossings.integers("sector_j")[row]);
    crossing.sector_q = static_cast<int>(crossings.integers("sector_q")[row]);
    crossing.fundamental_order = static_cast<int>(crossings.integers("fundamental_order")[row]);
    crossing.place_error = crossings.reals("place_error")[row];
    crossing.place_error_period = crossings.reals("place_error_period")[row];
    crossing.place_error_energy = crossings.reals("place_error_energy")[row];
    crossing.place_error_parameter = crossings.reals("place_error_parameter")[row];
    crossing.state = std::vector<double>(atlas.header().state_names.size(), 0.0);
    records.crossings.push_back(crossing);
  }
  const archive::Table& orbits = atlas.orbits();
  for (std::size_t row = 0; row < orbits.rows(); ++row) {
    archive::OrbitRecord orbit;
    orbit.family_key = key_of(orbits.integers("family")[row]);
    orbit.step = static_cast<int>(orbits.integers("step")[row]);
    orbit.arclength = orbits.reals("arclength")[row];
    const double birth = families.reals("birth_arclength")[static_cast<std::size_t>(orbits.integers("family")[row])];
    if (orbit.step < 0 && !std::isnan(birth)) orbit.arclength -= birth;
    orbit.period = orbits.reals("period")[row];
    orbit.energy = orbits.reals("energy")[row];
    orbit.action = orbits.reals("action")[row];
    orbit.parameter = orbits.reals("parameter")[row];
    if (const std::size_t angles = atlas.header().winding_names.size(); angles > 0)
      orbit.winding = row_of(atlas, "winding", row, angles);
    orbit.cutoff = static_cast<int>(orbits.integers("cutoff")[row]);
    orbit.loss_rms = orbits.reals("loss_rms")[row];
    const std::size_t width = archive::stability_width(atlas.header());
    orbit.stability = row_of(atlas, "stability", row, width);
    orbit.fundamental_stability = row_of(atlas, "fundamental_stability", row, width);
    orbit.stability_error = orbits.reals("stability_error")[row];
    orbit.log_volume = orbits.reals("log_volume")[row];
    orbit.state = row_of(atlas, "state", row, atlas.header().state_names.size());
    orbit.modes = atlas.modes(row);
    orbit.time_map = atlas.time_map(row);
    records.orbits.push_back(orbit);
  }
  return records;
}

/// The same with all that `verify` looks at.
inline archive::Records complete_records_of(const Atlas& atlas) {
  archive::Records records = records_of(atlas);
  const std::size_t d = atlas.header().state_names.size();
  for (std::size_t row = 0; row < records.crossings.size(); ++row) {
    archive::CrossingRecord& crossing = records.crossings[row];
    for (std::size_t i = 0; i < d; ++i) crossing.state[i] = atlas.crossings().reals("state")[row * d + i];
    crossing.residual = atlas.crossings().reals("residual")[row];
    crossing.test_value = atlas.crossings().reals("test_value")[row];
    crossing.kernel_residual = atlas.crossings().reals("kernel_residual")[row];
  }
  for (std::size_t row = 0; row < records.orbits.size(); ++row) {
    archive::OrbitRecord& orbit = records.orbits[row];
    orbit.closure = atlas.orbits().reals("closure")[row];
    orbit.single_shot = atlas.orbits().reals("single_shot")[row];
    orbit.energy_drift = atlas.orbits().reals("energy_drift")[row];
    orbit.verdict = static_cast<int>(atlas.orbits().integers("verdict")[row]);
    orbit.taylor_closure = atlas.orbits().reals("taylor_closure")[row];
    orbit.integrators_apart = atlas.orbits().reals("integrators_apart")[row];
    orbit.symmetry_defect = atlas.orbits().reals("symmetry_defect")[row];
    orbit.recurrence = atlas.orbits().reals("recurrence")[row];
    orbit.tail = atlas.orbits().reals("tail")[row];
    orbit.off_branch_eigenvalue = atlas.orbits().reals("off_branch_eigenvalue")[row];
  }
  const archive::Table& loci = atlas.loci();
  for (std::size_t row = 0; row < loci.rows(); ++row) {
    archive::LocusRecord point;
    point.family_key = key_of(loci.integers("family")[row]);
    point.crossing = static_cast<int>(loci.integers("crossing")[row]);
    point.locus = static_cast<int>(loci.integers("locus")[row]);
    point.step = static_cast<int>(loci.integers("step")[row]);
    point.arclength = loci.reals("arclength")[row];
    point.kind = archive::crossing_kind_of(loci.texts("kind")[row]);
    point.period = loci.reals("period")[row];
    point.energy = loci.reals("energy")[row];
    point.parameter = loci.reals("parameter")[row];
    point.second_parameter = loci.reals("second_parameter")[row];
    point.second_name = loci.texts("second_name")[row];
    point.sector_j = static_cast<int>(loci.integers("sector_j")[row]);
    point.sector_q = static_cast<int>(loci.integers("sector_q")[row]);
    point.fundamental_order = static_cast<int>(loci.integers("fundamental_order")[row]);
    const auto first = loci.reals("state").begin() + static_cast<std::ptrdiff_t>(row * d);
    point.state.assign(first, first + static_cast<std::ptrdiff_t>(d));
    point.note = loci.texts("note")[row];
    records.loci.push_back(point);
  }
  const archive::Table& equilibria = atlas.equilibria();
  for (std::size_t row = 0; row < equilibria.rows(); ++row) {
    archive::EquilibriumRecord point;
    point.equilibrium = static_cast<int>(equilibria.integers("equilibrium")[row]);
    point.step = static_cast<int>(equilibria.integers("step")[row]);
    point.arclength = equilibria.reals("arclength")[row];
    point.kind = equilibria.texts("kind")[row];
    point.parameter = equilibria.reals("parameter")[row];
    point.energy = equilibria.reals("energy")[row];
    point.stability = equilibria.texts("stability")[row];
    point.note = equilibria.texts("note")[row];
    const auto values = [&](const auto& all, const char* name, auto& into) {
      const std::size_t width = equilibria.column(name).spec.width();
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(row * width);
      into.assign(first, first + static_cast<std::ptrdiff_t>(width));
    };
    values(equilibria.reals("state"), "state", point.state);
    values(equilibria.reals("eigenvalues"), "eigenvalues", point.eigenvalues);
    values(equilibria.reals("periods"), "periods", point.periods);
    values(equilibria.integers("multiplicity"), "multiplicity", point.multiplicity);
    records.equilibria.push_back(point);
  }
  const archive::Table& sections = atlas.sections();
  for (std::size_t row = 0; row < sections.rows(); ++row) {
    const archive::OrbitRecord& orbit = records.orbits[static_cast<std::size_t>(sections.integers("orbit")[row])];
    const auto first = sections.reals("state").begin() + static_cast<std::ptrdiff_t>(row * d);
    records.sections.push_back(
        {orbit.family_key, orbit.step, sections.reals("time")[row], {first, first + static_cast<std::ptrdiff_t>(d)}});
  }
  for (std::size_t row = 0; row < records.families.size(); ++row) {
    records.families[row].end_family_key = key_of(atlas.families().integers("end_family")[row]);
    records.families[row].end_crossing = static_cast<int>(atlas.families().integers("end_crossing")[row]);
  }
  return records;
}

}  // namespace orbweaver::test
