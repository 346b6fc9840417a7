#include "plot/birth_pictures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "plot/axis_titles.hpp"
#include "plot/orbit_paths.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t neighbours = 4;  // of a polynomial along the parent
constexpr int instants_a_period = 2000;

/// The row of /crossings where the family was born.
std::size_t birth_of(const archive::Archive& atlas, std::size_t family) {
  const std::int64_t crossing = atlas.families().integers("crossing")[family];
  if (crossing < 0)
    throw core::InputError(fmt::format("`{}` of {} was born at no crossing: `birth` draws what leaves another family",
                                       atlas.families().texts("name")[family], atlas.path().string()));
  return static_cast<std::size_t>(crossing);
}

/// The orbit of least step, which lies nearest to the family's birth.
std::size_t first_born(const archive::Archive& atlas, std::size_t family) {
  const auto [first, count] = orbits_of(atlas, family);
  const std::vector<std::int64_t>& steps = atlas.orbits().integers("step");
  std::size_t nearest = first;
  for (std::size_t orbit = first; orbit < first + count; ++orbit)
    if (std::abs(steps[orbit]) < std::abs(steps[nearest])) nearest = orbit;
  return nearest;
}

using States = std::vector<std::vector<double>>;

/// States at equal times, from t = 0 to `periods` periods.
States states_of(const loop::Loop& loop, int periods) {
  States states;
  for (int n = 0; n <= periods * instants_a_period; ++n)
    states.push_back(loop::state_at(loop, loop.period * n / instants_a_period));
  return states;
}

/// An orbit that a family has between its stored ones, by polynomials in the arclength, with the stored one beside it.
struct Between {
  States states;
  loop::Loop beside;
};
Between at_arclength(const archive::Archive& atlas, const systems::System& system, std::size_t family, double arclength,
                     int periods) {
  const auto [first, count] = orbits_of(atlas, family);
  const std::vector<double>& arclengths = atlas.orbits().reals("arclength");
  const auto begin = arclengths.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = begin + static_cast<std::ptrdiff_t>(count);
  const auto behind = static_cast<std::size_t>(std::lower_bound(begin, end, arclength) - begin);
  const std::size_t nodes = std::min(neighbours, count);
  const std::size_t from = std::min(behind > nodes / 2 ? behind - nodes / 2 : 0, count - nodes);
  const std::vector<double> weights =
      numerics::lagrange_weights(std::span<const double>(arclengths.data() + first + from, nodes), arclength).value;
  Between between;
  double best = 0.0;
  loop::Loop last;
  for (std::size_t n = 0; n < nodes; ++n) {
    loop::Loop loop = survey::stored_loop(atlas, first + from + n, system);
    if (n > 0) loop = survey::started_as(system.structure(), loop, last);
    last = loop;
    const States states = states_of(loop, periods);
    between.states.resize(states.size(), std::vector<double>(states.front().size(), 0.0));
    for (std::size_t i = 0; i < states.size(); ++i)
      for (std::size_t k = 0; k < states[i].size(); ++k) between.states[i][k] += weights[n] * states[i][k];
    if (std::abs(weights[n]) > best) {
      best = std::abs(weights[n]);
      between.beside = loop;
    }
  }
  return between;
}

/// What of the difference no shift of time explains.
void take_out_time_shift(States& difference, const States& orbit) {
  double along = 0.0;
  double length = 0.0;
  const std::size_t last = orbit.size() - 1;
  const auto velocity = [&](std::size_t n, std::size_t k) {
    return orbit[n < last ? n + 1 : n][k] - orbit[n > 0 ? n - 1 : n][k];
  };
  for (std::size_t n = 1; n < last; ++n)
    for (std::size_t k = 0; k < orbit[n].size(); ++k) {
      along += difference[n][k] * velocity(n, k);
      length += velocity(n, k) * velocity(n, k);
    }
  for (std::size_t n = 1; n < last; ++n)
    for (std::size_t k = 0; k < orbit[n].size(); ++k) difference[n][k] -= along / length * velocity(n, k);
  difference.front() = difference.back() = difference[1];
}

std::vector<PlotPoint> path_of(const States& states, Plane plane, double factor) {
  std::vector<PlotPoint> points;
  for (const std::vector<double>& state : states)
    points.push_back({factor * state[plane.first], factor * state[plane.second]});
  return points;
}

std::string change_of(const archive::Archive& atlas, std::size_t coordinate) {
  return fmt::format("change of {}, enlarged", atlas.header().state_names[coordinate]);
}

}  // namespace

std::vector<Figure> birth_figures(const archive::Archive& atlas, const PlotRequest& request) {
  const std::size_t family = chosen_family(atlas, request);
  const std::size_t crossing = birth_of(atlas, family);
  const auto parent = static_cast<std::size_t>(atlas.families().integers("parent")[family]);
  const auto times = static_cast<int>(atlas.families().integers("multiplicity")[family]);
  const auto system = survey::scaled_system_of(atlas);
  const Plane plane = planes_of(atlas.header()).front();

  const Between at_birth = at_arclength(atlas, *system, parent, atlas.crossings().reals("arclength")[crossing], times);
  const loop::Loop repeated = loop::repeated(loop::evenly_in_time(at_birth.beside), times);
  const loop::Loop born = survey::stored_loop(atlas, first_born(atlas, family), *system);
  const loop::Loop begun_alike = loop::aligned(born, loop::align(system->structure(), born, repeated));
  States change;
  for (std::size_t n = 0; n < at_birth.states.size(); ++n) {
    const double part = static_cast<double>(n) / static_cast<double>(at_birth.states.size() - 1);
    change.push_back(loop::state_at(begun_alike, begun_alike.period * part));
    for (std::size_t k = 0; k < change.back().size(); ++k) change.back()[k] -= at_birth.states[n][k];
  }
  take_out_time_shift(change, at_birth.states);
  double largest = 0.0;
  for (const std::vector<double>& state : change)
    for (const std::size_t k : {plane.first, plane.second}) largest = std::max(largest, std::abs(state[k]));

  const std::string parent_name = atlas.families().texts("name")[parent];
  const auto panel = [&] {
    Figure figure = empty_panel(atlas, family, plane);
    figure.equal_scales = false;  // three frames of one height
    return figure;
  };
  Figure base = panel();
  const std::vector<double> scales{system->scales().coordinate(plane.first), system->scales().coordinate(plane.second)};
  std::vector<PlotPoint> path = path_of(at_birth.states, plane, 1.0);
  for (PlotPoint& p : path) p = {p.x * scales[0], p.y * scales[1]};
  base.series.push_back({fmt::format("{}, T = {:.5g}{}", parent_name, atlas.crossings().reals("period")[crossing],
                                     times > 1 ? fmt::format(" (× {})", times) : std::string()),
                         Look::solid, ink, path});
  Figure perturbation = panel();
  perturbation.x.title = change_of(atlas, plane.first);
  perturbation.y.title = change_of(atlas, plane.second);
  perturbation.series.push_back({"", Look::solid, plot_colours[1], path_of(change, plane, 1.0 / largest)});
  Figure along = panel();
  along.series.push_back({"", Look::thin, soft, path});
  base.series.push_back({"perturbation", Look::solid, plot_colours[1], {path.front()}});
  const std::vector<std::size_t> orbits = orbits_along(atlas, family);
  for (std::size_t n = 0; n < orbits.size(); ++n) {
    const loop::Loop loop = loop::in_units(survey::stored_loop(atlas, orbits[n], *system), system->scales());
    along.series.push_back({"", Look::solid, steps_of_colour[n], report::path_of(loop, plane), 7, 0.7});
    base.series.push_back(
        {n == 0 ? fmt::format("{}, {}", atlas.families().texts("name")[family], short_text(atlas, orbits[n]))
                : short_text(atlas, orbits[n]),
         Look::solid,
         steps_of_colour[n],
         {path.front()}});
  }
  return {base, perturbation, along};
}

}  // namespace orbweaver::report
