#include "orbweaver/survey/tree/naming.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace orbweaver::survey {

namespace {

bool is_angle(const systems::Description& system, std::size_t i) {
  return std::find(system.angles.begin(), system.angles.end(), static_cast<int>(i)) != system.angles.end();
}

bool is_at(const systems::Description& system, const std::vector<double>& point, const std::vector<double>& given) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    double difference = point[i] - given[i];
    if (is_angle(system, i)) difference = std::remainder(difference, 2.0 * std::numbers::pi);
    if (std::abs(difference) > 1e-6) return false;
  }
  return true;
}

}  // namespace

std::string base_family_name(const scene::Scene& scene, const systems::Description& system,
                             const std::vector<double>& point, int index, int mode) {
  for (const scene::FixedPoints::Names& entry : scene.fixed_points.names)
    if (is_at(system, point, entry.point) && static_cast<std::size_t>(mode) < entry.names.size())
      return entry.names[static_cast<std::size_t>(mode)];
  return fmt::format("Equilibrium {}, mode {}", index + 1, mode + 1);
}

std::string limited(std::string text) {
  constexpr std::size_t longest = 2000;
  if (text.size() > longest) text = text.substr(0, longest) + " ...";
  return text;
}

std::string point_text(const systems::Description& system, const std::vector<double>& point) {
  std::string text;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double value = is_angle(system, i) ? point[i] * 180.0 / std::numbers::pi : point[i];
    text += fmt::format("{}{} = {:.6g}{}", i == 0 ? "" : ", ", system.state_names[i],
                        std::abs(value) < 1e-9 ? 0.0 : value, is_angle(system, i) ? " deg" : "");
  }
  return text;
}

}  // namespace orbweaver::survey
