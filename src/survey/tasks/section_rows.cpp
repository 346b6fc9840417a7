#include "section_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/passages.hpp"

namespace orbweaver::survey {

namespace {

std::size_t coordinate_of(const scene::Section& section, const systems::System& system) {
  const std::vector<std::string>& names = system.info().state_names;
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), section.coordinate) - names.begin());
}

}  // namespace

std::vector<double> section_times(const scene::Section& section, const systems::System& system,
                                  const loop::Loop& stored) {
  if (section.coordinate.empty()) return {};
  const std::size_t coordinate = coordinate_of(section, system);
  return loop::passages(stored, static_cast<int>(coordinate), section.value, system.structure().is_angle(coordinate));
}

double section_distance(const scene::Section& section, const systems::System& system,
                        const std::vector<double>& state) {
  const std::size_t coordinate = coordinate_of(section, system);
  const double distance = state[coordinate] - section.value;
  return std::abs(system.structure().is_angle(coordinate) ? std::remainder(distance, 2.0 * std::numbers::pi)
                                                          : distance);
}

std::vector<archive::SectionRecord> section_rows(const scene::Section& section, const systems::System& system,
                                                 const loop::Loop& stored, const std::string& family, int step) {
  std::vector<archive::SectionRecord> rows;
  for (const double time : section_times(section, system, stored)) {
    archive::SectionRecord row{family, step, time * system.scales().time, loop::state_at(stored, time)};
    for (std::size_t i = 0; i < row.state.size(); ++i) row.state[i] *= system.scales().coordinate(i);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace orbweaver::survey
