#include "plot/orbit_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/scene/scene.hpp"
#include "plot/axis_titles.hpp"
#include "plot/family_curves.hpp"
#include "plot/label_places.hpp"
#include "show_level.hpp"
#include "stored_system.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t orbits_shown = 5;
constexpr int instants = 32;  // of a strobe picture
constexpr int points_a_harmonic = 12;
constexpr int fewest_points = 400;
constexpr int most_points = 8000;
/// From dark to light, even to the eye and to those who see few colours (viridis).
constexpr std::array<const char*, orbits_shown> steps_of_colour{"#440154", "#3b528b", "#21918c", "#5ec962", "#e0c020"};

struct OrbitChoice {
  std::size_t family;
  std::size_t orbit;
};

std::size_t chosen_family(const archive::Archive& atlas, const PlotRequest& request) {
  if (request.families.size() != 1)
    throw core::InputError(fmt::format("expected one --family for `{}`: it draws orbits of one family", request.what));
  const std::size_t family = family_row(atlas, request.families.front());
  if (orbits_of(atlas, family).count == 0)
    throw core::InputError(
        fmt::format("the family `{}` of {} has no orbits to draw", request.families.front(), atlas.path().string()));
  return family;
}

/// The step that was asked for, else the one in the middle of the family.
OrbitChoice chosen_orbit(const archive::Archive& atlas, const PlotRequest& request) {
  const std::size_t family = chosen_family(atlas, request);
  if (request.step) return {family, orbit_row(atlas, family, *request.step)};
  const auto [first, count] = orbits_of(atlas, family);
  return {family, first + count / 2};
}

std::string orbit_text(const archive::Archive& atlas, std::size_t orbit) {
  const Level level = level_of(atlas);
  const double value = atlas.orbits().reals(level.column)[orbit];
  std::string text = fmt::format("T = {:.5g}", atlas.orbits().reals("period")[orbit]);
  if (!std::isnan(value)) text += fmt::format(", {} = {:.5g}", level.title == "energy" ? "E" : level.title, value);
  return text;
}

/// What tells it from the other orbits of its family, in short.
std::string short_text(const archive::Archive& atlas, std::size_t orbit) {
  const std::string moving = atlas.moving_parameter();
  return moving.empty() ? fmt::format("T = {:.5g}", atlas.orbits().reals("period")[orbit])
                        : fmt::format("{} = {:.5g}", moving, atlas.orbits().reals("parameter")[orbit]);
}

std::string title_of(const archive::Archive& atlas, std::size_t family) {
  return fmt::format("{}: {}", system_title(atlas), atlas.families().texts("name")[family]);
}

/// Pairs of coordinates for the panels: in the plane the first two; of three coordinates the first with each other.
std::vector<std::pair<std::size_t, std::size_t>> panels_of(const archive::Header& header) {
  const std::size_t dimension = header.state_names.size();
  const std::size_t configuration = dimension >= 4 && dimension % 2 == 0 ? dimension / 2 : dimension;
  if (dimension == 1) return {{0, 0}};
  if (configuration == 3 && header.winding_names.empty()) return {{0, 1}, {0, 2}};
  return {{0, 1}};
}

bool has_lengths(const archive::Header& header, std::pair<std::size_t, std::size_t> panel) {
  const std::vector<int> angles = angles_of(header);
  const auto is_angle = [&](std::size_t i) {
    return std::find(angles.begin(), angles.end(), static_cast<int>(i)) != angles.end();
  };
  const bool both_positions = header.state_names.size() >= 4;
  return both_positions && is_angle(panel.first) == is_angle(panel.second);
}

double turned_back(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// A path in a plane of two coordinates; angles that turn over come back at the other side.
std::vector<PlotPoint> path_of(const loop::Loop& loop, std::pair<std::size_t, std::size_t> panel) {
  const int count = std::clamp(points_a_harmonic * loop.cutoff, fewest_points, most_points);
  std::vector<PlotPoint> points;
  const auto coordinate = [&](const std::vector<double>& state, std::size_t i) {
    return loop.winding[i] != 0.0 ? turned_back(state[i]) : state[i];
  };
  for (int n = 0; n <= count; ++n) {
    const double s = 2 * std::numbers::pi * n / count;
    const double time = loop.period * loop.time_map.phase(s) / (2 * std::numbers::pi);
    const std::vector<double> state = loop::state_at(loop, time);
    const PlotPoint point{coordinate(state, panel.first), coordinate(state, panel.second)};
    if (!points.empty() &&
        (std::abs(point.x - points.back().x) > std::numbers::pi ||
         std::abs(point.y - points.back().y) > std::numbers::pi) &&
        (loop.winding[panel.first] != 0.0 || loop.winding[panel.second] != 0.0))
      points.push_back({no_value, no_value});
    points.push_back(point);
  }
  return points;
}

Figure empty_panel(const archive::Archive& atlas, std::size_t family, std::pair<std::size_t, std::size_t> panel) {
  Figure figure{
      title_of(atlas, family), {coordinate_title(atlas, panel.first)}, {coordinate_title(atlas, panel.second)}};
  figure.equal_scales = has_lengths(atlas.header(), panel);
  return figure;
}

/// Equilibria, and the bodies of a restricted problem, where they lie in the picture.
/// In the legend with `keys`.
void add_fixed_places(Figure& figure, const archive::Archive& atlas, std::pair<std::size_t, std::size_t> panel,
                      bool keys) {
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
      add(rests, atlas.equilibria().reals("state")[row * dimension + panel.first],
          atlas.equilibria().reals("state")[row * dimension + panel.second]);
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

/// Whether the vertical coordinate of a panel rests, as z in the plane, but for rounding.
bool is_flat(const Figure& figure) {
  constexpr double rounding = 1e-9;
  double most_x = 0.0;
  double most_y = 0.0;
  for (const Series& series : figure.series)
    for (const PlotPoint& point : series.points) {
      if (std::isnan(point.x)) continue;
      most_x = std::max(most_x, std::abs(point.x - figure.series.front().points.front().x));
      most_y = std::max(most_y, std::abs(point.y - figure.series.front().points.front().y));
    }
  return most_y <= rounding * most_x;
}

using Rods = std::vector<PlotPoint>;

double parameter_of(const archive::Archive& atlas, const std::string& name) {
  const archive::Header& header = atlas.header();
  const auto found = std::find(header.parameter_names.begin(), header.parameter_names.end(), name);
  return found == header.parameter_names.end()
             ? no_value
             : header.parameter_values[static_cast<std::size_t>(found - header.parameter_names.begin())];
}

/// From the pivot to the last bob; empty: the system has none.
Rods rods_of(const archive::Archive& atlas, const std::vector<double>& state) {
  const std::string& system = atlas.header().system;
  if (system == "swinging_spring") return {{0.0, 0.0}, {state[0], state[1]}};
  if (system != "double_pendulum" && system != "pendulum_chain") return {};
  Rods rods{{0.0, 0.0}};
  for (std::size_t i = 0; i < state.size() / 2; ++i) {
    const double length = parameter_of(atlas, system == "pendulum_chain" ? "l" : i == 0 ? "l1" : "l2");
    rods.push_back({rods.back().x + length * std::sin(state[i]), rods.back().y - length * std::cos(state[i])});
  }
  return rods;
}

Figure rod_figure(const archive::Archive& atlas, const OrbitChoice& choice, const loop::Loop& loop) {
  Figure figure{title_of(atlas, choice.family), {length_title(atlas, "x")}, {length_title(atlas, "y")}};
  figure.equal_scales = true;
  Series rods{"", Look::thin, soft, {}};
  std::vector<Series> bobs;
  for (int n = 0; n < instants; ++n) {
    const Rods at = rods_of(atlas, loop::state_at(loop, loop.period * n / instants));
    rods.points.insert(rods.points.end(), at.begin(), at.end());
    rods.points.push_back({no_value, no_value});
    bobs.resize(at.size() - 1);
    for (std::size_t i = 1; i < at.size(); ++i) bobs[i - 1].points.push_back(at[i]);
  }
  figure.series.push_back(rods);
  for (std::size_t i = 0; i < bobs.size(); ++i)
    figure.series.push_back({bobs.size() == 1 ? "bob" : fmt::format("bob {}", i + 1), Look::marks,
                             plot_colours[i % plot_colours.size()], bobs[i].points, 7, 0.8});
  figure.series.push_back({"pivot", Look::marks, "#000000", {{0.0, 0.0}}, 9, 1.0});
  return figure;
}

}  // namespace

std::vector<Figure> orbit_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const std::size_t family = chosen_family(atlas, request);
  const std::vector<int> angles = angles_of(atlas.header());
  std::vector<std::size_t> orbits;
  const auto [first, count] = orbits_of(atlas, family);
  const std::size_t shown = std::min(orbits_shown, count);
  if (request.step) {
    orbits = {orbit_row(atlas, family, *request.step)};
  } else {
    for (std::size_t n = 0; n < shown; ++n) orbits.push_back(first + (shown == 1 ? 0 : n * (count - 1) / (shown - 1)));
  }
  std::vector<Figure> panels;
  for (const auto& panel : panels_of(atlas.header())) {
    Figure figure = empty_panel(atlas, family, panel);
    for (std::size_t n = 0; n < orbits.size(); ++n) {
      const std::string key = panels.empty() ? short_text(atlas, orbits[n]) : "";
      figure.series.push_back({key, Look::solid, orbits.size() == 1 ? plot_colours[0] : steps_of_colour[n],
                               path_of(archive::loop_of(atlas, orbits[n], angles), panel)});
    }
    if (!panels.empty() && is_flat(figure)) continue;
    add_fixed_places(figure, atlas, panel, panels.empty());
    panels.push_back(std::move(figure));
  }
  return panels;
}

std::vector<Figure> strobe_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const OrbitChoice choice = chosen_orbit(atlas, request);
  const loop::Loop loop = archive::loop_of(atlas, choice.orbit, angles_of(atlas.header()));
  if (!rods_of(atlas, loop::state_at(loop, 0.0)).empty()) return {rod_figure(atlas, choice, loop)};
  std::vector<Figure> panels;
  for (const auto& panel : panels_of(atlas.header())) {
    Figure figure = empty_panel(atlas, choice.family, panel);
    figure.series.push_back({"", Look::thin, soft, path_of(loop, panel)});
    Series places{panels.empty() ? fmt::format("every T/{}, {}", instants, short_text(atlas, choice.orbit)) : "",
                  Look::marks,
                  plot_colours[0],
                  {},
                  7,
                  0.8};
    for (int n = 0; n < instants; ++n) {
      const std::vector<double> state = loop::state_at(loop, loop.period * n / instants);
      const auto at = [&](std::size_t i) { return loop.winding[i] != 0.0 ? turned_back(state[i]) : state[i]; };
      places.points.push_back({at(panel.first), at(panel.second)});
    }
    figure.series.push_back(std::move(places));
    if (!panels.empty() && is_flat(figure)) continue;
    add_fixed_places(figure, atlas, panel, panels.empty());
    panels.push_back(std::move(figure));
  }
  return panels;
}

std::vector<Figure> spectrum_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const OrbitChoice choice = chosen_orbit(atlas, request);
  const loop::Loop loop = archive::loop_of(atlas, choice.orbit, angles_of(atlas.header()));
  Figure figure{fmt::format("{}, {}", title_of(atlas, choice.family), orbit_text(atlas, choice.orbit)),
                {"harmonic k"},
                {"modulus of the coefficients", Scale::logarithmic}};
  double largest = 0.0;
  for (const double mode : loop.modes) largest = std::max(largest, std::abs(mode));
  constexpr double rounding = 1e-18;  // beside the largest: what lies below is zero by symmetry
  for (int i = 0; i < loop.dimension; ++i) {
    Series series{atlas.header().state_names[static_cast<std::size_t>(i)],
                  Look::marks,
                  plot_colours[static_cast<std::size_t>(i) % plot_colours.size()],
                  {},
                  4 + 2 * (i % 5) + 1,
                  0.7};
    for (int k = 1; k <= loop.cutoff; ++k)
      if (const double modulus = std::hypot(loop.cosine(k, i), loop.sine(k, i)); modulus > rounding * largest)
        series.points.push_back({static_cast<double>(k), modulus});
    if (!series.points.empty()) figure.series.push_back(std::move(series));
  }
  if (figure.series.empty()) throw core::InputError("this orbit has no harmonics: it is a point");
  return {figure};
}

std::vector<Figure> section_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const scene::Scene scene = scene::parse(atlas.header().scene, atlas.path().string());
  const archive::Header& header = atlas.header();
  if (scene.section.coordinate.empty() || atlas.sections().rows() == 0)
    throw core::InputError(
        fmt::format("{} has no section points to draw: its scene has no `section:`", atlas.path().string()));
  const FamilyCurves curves(atlas, request.families);
  const std::size_t dimension = header.state_names.size();
  const auto fixed = static_cast<std::size_t>(
      std::find(header.state_names.begin(), header.state_names.end(), scene.section.coordinate) -
      header.state_names.begin());
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < dimension; ++i)
    if (i != fixed) rest.push_back(i);
  // Of two positions and their velocities: the other position and its own.
  std::pair<std::size_t, std::size_t> panel{rest[0], rest.size() > 1 ? rest[1] : rest[0]};
  if (dimension == 4) panel = {fixed % 2 == 0 ? 1 : 0, fixed % 2 == 0 ? 3 : 2};
  const std::vector<int> angles = angles_of(header);
  const auto value = [&](std::size_t row, std::size_t i) {
    const double x = atlas.sections().reals("state")[row * dimension + i];
    return std::find(angles.begin(), angles.end(), static_cast<int>(i)) != angles.end() ? turned_back(x) : x;
  };
  Figure figure{fmt::format("{}: section {}", system_title(atlas), scene.section.coordinate),
                {coordinate_title(atlas, panel.first)},
                {coordinate_title(atlas, panel.second)}};
  std::set<std::string> known_colours;
  for (const std::size_t family : curves.families()) {
    Series series{"", Look::dots, curves.colour(family), {}, 7, 1.6};
    for (std::size_t row = 0; row < atlas.sections().rows(); ++row) {
      const auto orbit = static_cast<std::size_t>(atlas.sections().integers("orbit")[row]);
      if (atlas.orbits().integers("family")[orbit] == static_cast<std::int64_t>(family))
        series.points.push_back({value(row, panel.first), value(row, panel.second)});
    }
    if (series.points.empty()) continue;
    if (known_colours.insert(series.colour).second) series.key = cut(curves.name(family), longest_plot_name);
    figure.series.push_back(std::move(series));
  }
  if (figure.series.empty()) throw core::InputError("no orbit of these families passes the section");
  return {figure};
}

}  // namespace orbweaver::report
