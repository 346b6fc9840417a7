#include "orbweaver/survey/tree/naming.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace orbweaver::survey {

namespace {

/// Equilibria are found to rounding, and names are given for points with some digits.
constexpr double same_place = 1e-6;
/// In radians or the coordinate's scale: printed as 0.
constexpr double printed_as_zero = 1e-9;
/// Of a point with more coordinates only those that are not 0 are told.
constexpr std::size_t most_told = 4;

bool is_named_point(const systems::System& system, const std::vector<double>& point, const std::vector<double>& given) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    double difference = point[i] - given[i];
    if (system.structure().is_angle(i)) difference = std::remainder(difference, 2.0 * std::numbers::pi);
    if (std::abs(difference) > same_place) return false;
  }
  return true;
}

}  // namespace

std::size_t names_given(const scene::Scene& scene, const systems::System& system, const std::vector<double>& point) {
  std::size_t most = 0;
  for (const scene::FixedPoints::Names& entry : scene.fixed_points.names)
    if (is_named_point(system, point, entry.point)) most = std::max(most, entry.names.size());
  return most;
}

std::string base_family_name(const scene::Scene& scene, const systems::System& system, const std::vector<double>& point,
                             int index, int mode) {
  for (const scene::FixedPoints::Names& entry : scene.fixed_points.names)
    if (is_named_point(system, point, entry.point) && static_cast<std::size_t>(mode) < entry.names.size())
      return entry.names[static_cast<std::size_t>(mode)];
  return fmt::format("{}, mode {}", equilibrium_name(index), mode + 1);
}

std::string equilibrium_name(int index) { return fmt::format("Equilibrium {}", index + 1); }

std::string limited(std::string text) {
  constexpr std::size_t longest = 2000;
  if (text.size() > longest) text = text.substr(0, longest) + " ...";
  return text;
}

std::string point_text(const systems::System& system, const std::vector<double>& point) {
  const bool only_others = point.size() > most_told;
  std::vector<std::string> told;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const bool is_zero = std::abs(point[i]) < printed_as_zero;
    if (is_zero && only_others) continue;
    const bool is_angle = system.structure().is_angle(i);
    const double value = point[i] * system.scales().coordinate(i) * (is_angle ? 180.0 / std::numbers::pi : 1.0);
    told.push_back(
        fmt::format("{} = {:.6g}{}", system.info().state_names[i], is_zero ? 0.0 : value, is_angle ? " deg" : ""));
  }
  if (told.size() < point.size()) told.emplace_back(told.empty() ? "all coordinates 0" : "the others 0");
  return fmt::format("{}", fmt::join(told, ", "));
}

}  // namespace orbweaver::survey
