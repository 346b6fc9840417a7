#include "export/exported_rows.hpp"

#include <numeric>

#include <fmt/format.h>

#include "family_row.hpp"

namespace orbweaver::report {

std::vector<std::size_t> exported_rows(const archive::Archive& atlas, const ExportSelection& selection) {
  if (selection.family.empty() && selection.step)
    throw core::InputError("expected --family with --step: steps are numbered along a family");
  OrbitRange range{0, atlas.orbits().rows()};
  if (range.count == 0)
    throw core::InputError(fmt::format("{} has no orbits: there is nothing to export", atlas.path().string()));
  if (!selection.family.empty()) {
    const std::size_t family = family_row(atlas, selection.family);
    if (selection.step) return {orbit_row(atlas, family, *selection.step)};
    range = orbits_of(atlas, family);
    if (range.count == 0)
      throw core::InputError(fmt::format("the family `{}` of {} has no orbits: {}", selection.family,
                                         atlas.path().string(), atlas.families().texts("end_reason")[family]));
  }
  std::vector<std::size_t> rows(range.count);
  std::iota(rows.begin(), rows.end(), range.first);
  return rows;
}

std::vector<double> parameters_at(const archive::Archive& atlas, std::size_t orbit) {
  std::vector<double> values = atlas.header().parameter_values;
  const std::string moving = atlas.moving_parameter();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (atlas.header().parameter_names[i] == moving) values[i] = atlas.orbits().reals("parameter")[orbit];
  return values;
}

}  // namespace orbweaver::report
