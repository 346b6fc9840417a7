#include "orbweaver/survey/tree/naming.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/starts/fixed_points.hpp"

namespace orbweaver::survey {

namespace {

/// Equilibria are found to rounding, and names are given for points with some digits.
constexpr double same_place = 1e-6;
/// In radians or the coordinate's scale: printed as 0.
constexpr double printed_as_zero = 1e-9;
/// Of a point with more coordinates only those that are not 0 are told.
constexpr std::size_t most_told = 4;

/// The largest difference in a coordinate that is given, angles modulo a turn.
double distance(const systems::System& system, const std::vector<double>& point, const std::vector<double>& given) {
  double most = 0.0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double difference = point[i] - given[i];
    most = std::max(most, std::abs(system.structure().is_angle(i) ? std::remainder(difference, 2.0 * std::numbers::pi)
                                                                  : difference));
  }
  return most;
}

bool is_named_point(const systems::System& system, const std::vector<double>& point, const std::vector<double>& given) {
  return distance(system, point, given) <= same_place;
}

/// As a key of starts.fixed_points.names: with digits enough to be taken for the same place.
std::string key_of(const systems::System& system, const std::vector<double>& point) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double unit = system.structure().is_angle(i) ? 180.0 / std::numbers::pi : system.scales().coordinate(i);
    values.push_back(fmt::format("{:.10g}", std::abs(point[i]) < printed_as_zero ? 0.0 : point[i] * unit));
  }
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

void require_named(const scene::Scene& scene, const systems::System& system,
                   const std::vector<std::vector<double>>& equilibria) {
  for (const scene::FixedPoints::Names& entry : scene.fixed_points.names) {
    const auto away = [&](const std::vector<double>& point) { return distance(system, point, entry.point); };
    const auto is_meant = [&](const std::vector<double>& point) { return away(point) <= same_place; };
    if (std::any_of(equilibria.begin(), equilibria.end(), is_meant)) continue;
    std::vector<double> at = entry.point;
    at.resize(static_cast<std::size_t>(system.dimension()), 0.0);
    std::vector<std::vector<double>> known = equilibria;
    if (auto near = starts::fixed_point_near(system, at, std::numeric_limits<double>::infinity())) {
      if (is_meant(*near)) continue;  // the grid does not lead to it
      known.push_back(*std::move(near));
    }
    const auto nearest =
        std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) { return away(a) < away(b); });
    throw core::InputError(
        fmt::format("starts.fixed_points.names: expected places of equilibria, got {} ({}), where none is: {}",
                    key_of(system, entry.point), fmt::join(entry.names, ", "),
                    nearest == known.end() ? "remove the names, or correct their place"
                                           : "the nearest known is " + key_of(system, *nearest) +
                                                 ": give that place if it is meant, or remove the names"));
  }
}

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
