#include "plot/axis_titles.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "show_level.hpp"
#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

/// Whether parameters are told in kg, m and s: then times are in seconds and energies in joules.
bool has_units(const archive::Archive& atlas) {
  const std::vector<std::string> units = units_of(atlas.header());
  return std::any_of(units.begin(), units.end(), [](const std::string& unit) {
    return unit == "m/s^2" || unit == "N/m" || unit == "kg/s" || unit == "rad/s";
  });
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : fmt::format("{} [{}]", name, unit);
}

}  // namespace

std::string period_title(const archive::Archive& atlas) { return with_unit("period T", has_units(atlas) ? "s" : ""); }

std::string level_title(const archive::Archive& atlas) {
  const std::string moving = atlas.moving_parameter();
  if (moving.empty()) return with_unit("energy E", has_units(atlas) ? "J" : "");
  const std::vector<std::string>& names = atlas.header().parameter_names;
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), moving) - names.begin());
  return index < names.size() ? with_unit(moving, units_of(atlas.header())[index]) : moving;
}

std::string coordinate_title(const archive::Archive& atlas, std::size_t coordinate) {
  const std::vector<int> angles = angles_of(atlas);
  const bool is_angle = std::find(angles.begin(), angles.end(), static_cast<int>(coordinate)) != angles.end();
  return with_unit(atlas.header().state_names[coordinate], is_angle ? "rad" : "");
}

std::string length_title(const archive::Archive& atlas, const char* name) {
  return with_unit(name, has_units(atlas) ? "m" : "");
}

std::string system_title(const archive::Archive& atlas) {
  const systems::ModelInfo* info = info_of(atlas.header());
  return info == nullptr ? atlas.header().system : info->title;
}

}  // namespace orbweaver::report
