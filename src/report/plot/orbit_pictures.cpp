#include "plot/orbit_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/scene/scene.hpp"
#include "plot/axis_titles.hpp"
#include "plot/family_curves.hpp"
#include "plot/label_places.hpp"
#include "plot/orbit_paths.hpp"
#include "show_level.hpp"
#include "stored_system.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr int instants = 32;  // of a strobe picture

std::string orbit_text(const archive::Archive& atlas, std::size_t orbit) {
  const Level level = level_of(atlas);
  const double value = atlas.orbits().reals(level.column)[orbit];
  std::string text = fmt::format("T = {:.5g}", atlas.orbits().reals("period")[orbit]);
  if (!std::isnan(value)) text += fmt::format(", {} = {:.5g}", level.title == "energy" ? "E" : level.title, value);
  return text;
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

/// The points of the section in a plane of two coordinates.
Figure section_panel(const archive::Archive& atlas, const FamilyCurves& curves, Plane plane,
                     const std::string& coordinate) {
  const archive::Header& header = atlas.header();
  const std::size_t dimension = header.state_names.size();
  const std::vector<int> angles = angles_of(atlas);
  const auto value = [&](std::size_t row, std::size_t i) {
    const double x = atlas.sections().reals("state")[row * dimension + i];
    return std::find(angles.begin(), angles.end(), static_cast<int>(i)) != angles.end() ? turned_back(x) : x;
  };
  Figure figure{fmt::format("{}: section {}", system_title(atlas), coordinate),
                {coordinate_title(atlas, plane.first)},
                {coordinate_title(atlas, plane.second)}};
  std::set<std::string> known_colours;
  for (const std::size_t family : curves.families()) {
    Series series{"", Look::dots, curves.colour(family), {}, 7, 1.6};
    for (std::size_t row = 0; row < atlas.sections().rows(); ++row) {
      const auto orbit = static_cast<std::size_t>(atlas.sections().integers("orbit")[row]);
      if (atlas.orbits().integers("family")[orbit] == static_cast<std::int64_t>(family))
        series.points.push_back({value(row, plane.first), value(row, plane.second)});
    }
    if (series.points.empty()) continue;
    constexpr std::size_t many = 500;  // points that make a line
    if (series.points.size() > many) series.size = 0.9;
    if (known_colours.insert(series.colour).second)
      series.key = cut(curves.name(family), longest_plot_name);
    else
      figure.named.push_back({curves.name(family), series.colour, series.points});
    figure.named.push_back({"", series.colour, series.points});
    figure.series.push_back(std::move(series));
  }
  return figure;
}

}  // namespace

std::vector<Figure> orbit_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const std::size_t family = chosen_family(atlas, request);
  const std::vector<int> angles = angles_of(atlas);
  const std::vector<std::size_t> orbits =
      request.step ? std::vector<std::size_t>{orbit_row(atlas, family, *request.step)} : orbits_along(atlas, family);
  std::vector<Figure> panels;
  for (const auto& panel : planes_of(atlas.header())) {
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
  const loop::Loop loop = archive::loop_of(atlas, choice.orbit, angles_of(atlas));
  if (!rods_of(atlas, loop::state_at(loop, 0.0)).empty()) return {rod_figure(atlas, choice, loop)};
  std::vector<Figure> panels;
  for (const auto& panel : planes_of(atlas.header())) {
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
  const loop::Loop loop = archive::loop_of(atlas, choice.orbit, angles_of(atlas));
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
  const std::string coordinate = scene::written_value(atlas.header().scene, "section.coordinate");
  const archive::Header& header = atlas.header();
  if (coordinate.empty() || atlas.sections().rows() == 0)
    throw core::InputError(
        fmt::format("{} has no section points to draw: its scene has no `section:`", atlas.path().string()));
  const FamilyCurves curves(atlas, request.families);
  const std::size_t dimension = header.state_names.size();
  const auto fixed = static_cast<std::size_t>(
      std::find(header.state_names.begin(), header.state_names.end(), coordinate) - header.state_names.begin());
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < dimension; ++i)
    if (i != fixed) rest.push_back(i);
  // Of two positions and their velocities: the other position and its own; where a velocity is held both positions too.
  std::vector<Plane> planes{{rest[0], rest.size() > 1 ? rest[1] : rest[0]}};
  if (dimension == 4) planes = {{fixed % 2 == 0 ? 1 : 0, fixed % 2 == 0 ? 3 : 2}};
  if (dimension == 4 && fixed >= 2) planes.insert(planes.begin(), {0, 1});
  std::vector<Figure> panels;
  for (const Plane& plane : planes) panels.push_back(section_panel(atlas, curves, plane, coordinate));
  if (panels.front().series.empty()) throw core::InputError("no orbit of these families passes the section");
  for (std::size_t n = 0; n < planes.size(); ++n)
    if (planes[n].second < dimension / 2) add_fixed_places(panels[n], atlas, planes[n], n == 0);
  return panels;
}

}  // namespace orbweaver::report
