#include "plot/orbit_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "family_row.hpp"
#include "orbweaver/core/error.hpp"
#include "plot/axis_titles.hpp"
#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

constexpr int points_a_harmonic = 12;
constexpr int fewest_points = 400;
constexpr int most_points = 8000;

bool is_angle(const archive::Archive& atlas, std::size_t coordinate) {
  const std::vector<int> angles = angles_of(atlas);
  return std::find(angles.begin(), angles.end(), static_cast<int>(coordinate)) != angles.end();
}

}  // namespace

std::size_t chosen_family(const archive::Archive& atlas, const PlotRequest& request) {
  if (request.families.size() != 1)
    throw core::InputError(fmt::format("expected one --family for `{}`: it draws orbits of one family", request.what));
  const std::size_t family = family_row(atlas, request.families.front());
  if (orbits_of(atlas, family).count == 0)
    throw core::InputError(
        fmt::format("the family `{}` of {} has no orbits to draw", request.families.front(), atlas.path().string()));
  return family;
}

OrbitChoice chosen_orbit(const archive::Archive& atlas, const PlotRequest& request) {
  const std::size_t family = chosen_family(atlas, request);
  if (request.step) return {family, orbit_row(atlas, family, *request.step)};
  const auto [first, count] = orbits_of(atlas, family);
  return {family, first + count / 2};
}

std::vector<std::size_t> orbits_along(const archive::Archive& atlas, std::size_t family) {
  const auto [first, count] = orbits_of(atlas, family);
  const std::size_t shown = std::min(orbits_shown, count);
  std::vector<std::size_t> orbits;
  for (std::size_t n = 0; n < shown; ++n) orbits.push_back(first + (shown == 1 ? 0 : n * (count - 1) / (shown - 1)));
  return orbits;
}

std::string short_text(const archive::Archive& atlas, std::size_t orbit) {
  const std::string moving = atlas.moving_parameter();
  return moving.empty() ? fmt::format("T = {:.5g}", atlas.orbits().reals("period")[orbit])
                        : fmt::format("{} = {:.5g}", moving, atlas.orbits().reals("parameter")[orbit]);
}

std::string title_of(const archive::Archive& atlas, std::size_t family) {
  return fmt::format("{}: {}", system_title(atlas), atlas.families().texts("name")[family]);
}

std::vector<Plane> planes_of(const archive::Header& header) {
  const std::size_t dimension = header.state_names.size();
  const std::size_t configuration = dimension >= 4 && dimension % 2 == 0 ? dimension / 2 : dimension;
  if (dimension == 1) return {{0, 0}};
  if (configuration == 3 && header.winding_names.empty()) return {{0, 1}, {0, 2}};
  return {{0, 1}};
}

double turned_back(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

std::vector<PlotPoint> path_of(const loop::Loop& loop, Plane plane) {
  const int count = std::clamp(points_a_harmonic * loop.cutoff, fewest_points, most_points);
  std::vector<PlotPoint> points;
  const auto coordinate = [&](const std::vector<double>& state, std::size_t i) {
    return loop.winding[i] != 0.0 ? turned_back(state[i]) : state[i];
  };
  for (int n = 0; n <= count; ++n) {
    const double s = 2 * std::numbers::pi * n / count;
    const double time = loop.period * loop.time_map.phase(s) / (2 * std::numbers::pi);
    const std::vector<double> state = loop::state_at(loop, time);
    const PlotPoint point{coordinate(state, plane.first), coordinate(state, plane.second)};
    if (!points.empty() &&
        (std::abs(point.x - points.back().x) > std::numbers::pi ||
         std::abs(point.y - points.back().y) > std::numbers::pi) &&
        (loop.winding[plane.first] != 0.0 || loop.winding[plane.second] != 0.0))
      points.push_back({no_value, no_value});
    points.push_back(point);
  }
  return points;
}

Figure empty_panel(const archive::Archive& atlas, std::size_t family, Plane plane) {
  Figure figure{
      title_of(atlas, family), {coordinate_title(atlas, plane.first)}, {coordinate_title(atlas, plane.second)}};
  figure.equal_scales =
      atlas.header().state_names.size() >= 4 && is_angle(atlas, plane.first) == is_angle(atlas, plane.second);
  return figure;
}

void add_fixed_places(Figure& figure, const archive::Archive& atlas, Plane plane, bool keys) {
  double low_x = std::numeric_limits<double>::infinity();
  double high_x = -low_x;
  double low_y = low_x;
  double high_y = -low_x;
  for (const Series& series : figure.series)
    for (const PlotPoint& p : series.points) {
      if (std::isnan(p.x)) continue;
      low_x = std::min(low_x, p.x);
      high_x = std::max(high_x, p.x);
      low_y = std::min(low_y, p.y);
      high_y = std::max(high_y, p.y);
    }
  const double more = 0.1 * std::max(high_x - low_x, high_y - low_y);
  const auto add = [&](Series& series, double x, double y) {
    if (x > low_x - more && x < high_x + more && y > low_y - more && y < high_y + more) series.points.push_back({x, y});
  };
  const archive::Header& header = atlas.header();
  const std::size_t dimension = header.state_names.size();
  Series rests{keys ? "equilibrium" : "", Look::marks, "#000000", {}, 1, 1.2};
  for (std::size_t row = 0; row < atlas.equilibria().rows(); ++row)
    if (atlas.equilibria().integers("step")[row] == 0)
      add(rests, atlas.equilibria().reals("state")[row * dimension + plane.first],
          atlas.equilibria().reals("state")[row * dimension + plane.second]);
  Series bodies{keys ? "body" : "", Look::marks, soft, {}, 7, 1.6};
  const auto mu = std::find(header.parameter_names.begin(), header.parameter_names.end(), "mu");
  if ((header.system == "pcr3bp" || header.system == "cr3bp") && mu != header.parameter_names.end()) {
    const double mass = header.parameter_values[static_cast<std::size_t>(mu - header.parameter_names.begin())];
    add(bodies, -mass, 0.0);
    add(bodies, 1.0 - mass, 0.0);
  }
  if (!rests.points.empty()) figure.series.push_back(std::move(rests));
  if (!bodies.points.empty()) figure.series.push_back(std::move(bodies));
}

}  // namespace orbweaver::report
