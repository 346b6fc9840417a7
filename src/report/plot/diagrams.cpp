#include "plot/diagrams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/document/units.hpp"
#include "orbweaver/scene/scene.hpp"
#include "plot/axis_titles.hpp"
#include "plot/family_curves.hpp"
#include "plot/label_places.hpp"
#include "plot/twice_around.hpp"
#include "show_level.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr double mark_size = 1.0;

/// How a kind of crossing is marked; none for kinds that this program does not know.
struct Mark {
  archive::CrossingKind kind;
  const char* key;
  int type;
};
constexpr Mark marks[] = {
    {archive::CrossingKind::branch_point, "branch point", 6},
    {archive::CrossingKind::period_doubling, "period doubling", 4},
    {archive::CrossingKind::subharmonic, "subharmonic", 8},
    {archive::CrossingKind::fold_energy, "fold in energy", 1},
    {archive::CrossingKind::fold_period, "fold in period", 2},
    {archive::CrossingKind::fold_parameter, "fold", 3},
    {archive::CrossingKind::torus, "torus", 12},
    {archive::CrossingKind::krein, "Krein", 10},
};

bool is_drawn(const FamilyCurves& curves, std::int64_t family) {
  const auto& families = curves.families();
  return std::find(families.begin(), families.end(), static_cast<std::size_t>(family)) != families.end();
}

/// Crossings at (x, y) of each, by kind.
template <class Place>
void add_marks(Figure& figure, const FamilyCurves& curves, const Place& place) {
  const archive::Archive& atlas = curves.atlas();
  for (const Mark& mark : marks) {
    Series series{mark.key, Look::marks, ink, {}, mark.type, mark_size};
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
      if (atlas.crossing_kinds()[row] == mark.kind && is_drawn(curves, atlas.crossings().integers("family")[row]))
        if (const PlotPoint point = place(row); std::isfinite(point.x) && std::isfinite(point.y))
          series.points.push_back(point);
    if (!series.points.empty()) figure.series.push_back(std::move(series));
  }
}

/// Families that have a colour of their own, and what solid, dashed and dotted lines say, of those that are there:
/// entries of the legend, of one point each, which no line shows.
void add_legend(Figure& figure, const FamilyCurves& curves) {
  std::vector<Series> entries;
  const auto add = [&](const std::string& key, Look look, const std::string& colour, const PlotPoint& point) {
    entries.push_back({key, look, colour, {point}});
  };
  for (const std::size_t family : curves.coloured()) {
    const auto drawn = std::find_if(figure.series.begin(), figure.series.end(),
                                    [&](const Series& s) { return s.colour == curves.colour(family); });
    if (drawn != figure.series.end())
      add(cut(curves.name(family), longest_plot_name), Look::solid, curves.colour(family), drawn->points.front());
  }
  const std::pair<Look, const char*> words[] = {
      {Look::solid, "stable"}, {Look::dashed, "unstable"}, {Look::dotted, "stability not known"}};
  for (const auto& [look, word] : words) {
    const auto drawn = std::find_if(figure.series.begin(), figure.series.end(),
                                    [look = look](const Series& s) { return s.look == look; });
    if (drawn != figure.series.end()) add(word, look, ink, drawn->points.front());
  }
  figure.series.insert(figure.series.end(), entries.begin(), entries.end());
}

/// Curves of families; those that the legend does not name have their names beside them.
void add_families(Figure& figure, const FamilyCurves& curves, const FamilyCurves::Number& x,
                  const FamilyCurves::Number& y) {
  const std::vector<std::size_t> coloured = curves.coloured();
  for (const std::size_t family : curves.families()) {
    std::vector<Series> drawn = curves.drawn(family, x, figure.x, y, figure.y);
    figure.series.insert(figure.series.end(), drawn.begin(), drawn.end());
    NamedCurve named = curves.named(family, x, figure.x, y, figure.y);
    if (std::find(coloured.begin(), coloured.end(), family) != coloured.end()) named.name.clear();
    figure.named.push_back(std::move(named));
  }
}

/// Families in a plane of two columns of /orbits, with their crossings.
Figure plane(const archive::Archive& atlas, const PlotRequest& request, const std::string& title, Axis x_axis,
             const char* x, Axis y_axis, const char* y) {
  const FamilyCurves curves(atlas, request.families);
  Figure figure{fmt::format("{}: {}", system_title(atlas), title), std::move(x_axis), std::move(y_axis)};
  add_families(figure, curves, curves.column(x), curves.column(y));
  add_legend(figure, curves);
  add_marks(figure, curves, [&](std::size_t row) {
    return PlotPoint{atlas.crossings().reals(x)[row], atlas.crossings().reals(y)[row]};
  });
  return figure;
}

void require_values(const archive::Archive& atlas, const FamilyCurves& curves, const char* column,
                    const std::string& advice) {
  const std::vector<double>& values = atlas.orbits().reals(column);
  const std::size_t width = atlas.orbits().column(column).spec.width();
  for (const std::size_t family : curves.families()) {
    const auto [first, count] = orbits_of(atlas, family);
    for (std::size_t n = first * width; n < (first + count) * width; ++n)
      if (!std::isnan(values[n])) return;
  }
  throw core::InputError(fmt::format("{} has nothing to draw: no `{}` of these families was computed ({})",
                                     atlas.path().string(), column, advice));
}

/// Crossings above the curves, by kind.
void add_marks_above(Figure& figure, const FamilyCurves& curves, const char* column) {
  double highest = 0.0;
  for (const Series& series : figure.series)
    for (const PlotPoint& point : series.points)
      if (std::isfinite(point.y)) highest = std::max(highest, point.y);
  constexpr double above = 4.0;  // on a logarithmic axis
  add_marks(figure, curves, [&](std::size_t row) {
    return PlotPoint{curves.atlas().crossings().reals(column)[row], above * highest};
  });
}

/// A line across the picture at a height.
void add_level(Figure& figure, double height, double from, double to) {
  figure.series.insert(figure.series.begin(), Series{"", Look::thin, soft, {{from, height}, {to, height}}});
}

/// What tells the orbits of a family apart: the parameter that moves, else the period.
struct Abscissa {
  Axis axis;
  const char* column;
};
Abscissa abscissa_of(const archive::Archive& atlas) {
  if (atlas.moving_parameter().empty()) return {{period_title(atlas)}, "period"};
  return {{level_title(atlas)}, "parameter"};
}

std::pair<double, double> range_along(const FamilyCurves& curves, const char* column) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const std::size_t family : curves.families()) {
    const auto [first, count] = orbits_of(curves.atlas(), family);
    for (std::size_t orbit = first; orbit < first + count; ++orbit) {
      low = std::min(low, curves.atlas().orbits().reals(column)[orbit]);
      high = std::max(high, curves.atlas().orbits().reals(column)[orbit]);
    }
  }
  return {low, high};
}

}  // namespace

Figure tree_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const Level level = level_of(atlas);
  if (level.column == std::string("parameter"))
    return plane(atlas, request, "tree of families", {level_title(atlas)}, level.column, {period_title(atlas)},
                 "period");
  return plane(atlas, request, "tree of families", {period_title(atlas)}, "period", {level_title(atlas)}, level.column);
}

Figure energy_period_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const std::string moving = atlas.moving_parameter();
  require_values(atlas, FamilyCurves(atlas, request.families), "energy",
                 moving.empty() ? "the system conserves none"
                                : fmt::format("the system conserves none: `tree` draws the period against {}", moving));
  const Axis energy{moving.empty() ? level_title(atlas) : "energy E"};
  return plane(atlas, request, "period against energy", energy, "energy", {period_title(atlas)}, "period");
}

Figure off_branch_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const FamilyCurves curves(atlas, request.families);
  const Abscissa abscissa = abscissa_of(atlas);
  require_values(atlas, curves, "off_branch_eigenvalue", "set `survey.spectrum: all` in the scene");
  Figure figure{fmt::format("{}: smallest eigenvalue off the family's direction", system_title(atlas)),
                abscissa.axis,
                {"off-branch eigenvalue", Scale::logarithmic}};
  // Polynomials would swing beside a dip, which is infinitely deep as the axis has it.
  const auto& xs = atlas.orbits().reals(abscissa.column);
  const auto add = [&](const std::string& key, Look look, const std::string& colour, std::size_t family,
                       const std::vector<double>& values, std::size_t first_value) {
    Series series{key, look, colour, {}, 7, look == Look::thin ? 2.0 : 1.0};
    const auto [first, count] = orbits_of(atlas, family);
    for (std::size_t n = 0; n < count; ++n) series.points.push_back({xs[first + n], values[first_value + n]});
    figure.named.push_back({key.empty() ? curves.name(family) : "", colour, series.points});
    figure.series.push_back(std::move(series));
  };
  const std::vector<double>& once = atlas.orbits().reals("off_branch_eigenvalue");
  if (request.families.size() == 1) {
    const std::size_t family = curves.families().front();
    add("once around", Look::solid, plot_colours[0], family, once, orbits_of(atlas, family).first);
    add("twice around, odd harmonics", Look::dashed, plot_colours[1], family, eigenvalues_twice_around(atlas, family),
        0);
    add_marks_above(figure, curves, abscissa.column);
  } else {
    for (const std::size_t family : curves.families())
      add("", Look::thin, curves.colour(family), family, once, orbits_of(atlas, family).first);
    add_legend(figure, curves);
  }
  return figure;
}

Figure accuracy_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const FamilyCurves curves(atlas, request.families);
  if (request.families.size() != 1)
    throw core::InputError("expected one --family for `accuracy`: it draws several numbers of one");
  const Abscissa abscissa = abscissa_of(atlas);
  const std::size_t family = curves.families().front();
  const auto [first, count] = orbits_of(atlas, family);
  Figure figure{fmt::format("{}: {}", system_title(atlas), curves.name(family)),
                abscissa.axis,
                {"root of the loss; gaps", Scale::logarithmic}};
  const std::tuple<const char*, const char*, Look> numbers[] = {{"loss_rms", "root of the loss", Look::solid},
                                                                {"closure", "gap of pieces", Look::dashed},
                                                                {"single_shot", "gap once around", Look::dotted}};
  for (std::size_t n = 0; n < std::size(numbers); ++n) {
    const auto& [column, key, look] = numbers[n];
    Series series{key, look, plot_colours[n], {}};
    for (std::size_t orbit = first; orbit < first + count; ++orbit)
      series.points.push_back({atlas.orbits().reals(abscissa.column)[orbit], atlas.orbits().reals(column)[orbit]});
    figure.series.push_back(std::move(series));
  }
  const auto [low, high] = range_along(curves, abscissa.column);
  const std::string tolerance = scene::written_value(atlas.header().scene, "continuation.tolerance");
  add_level(figure, document::parse_number(tolerance).value_or(scene::Continuation{}.tolerance), low, high);
  return figure;
}

Figure stability_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const FamilyCurves curves(atlas, request.families);
  const Abscissa abscissa = abscissa_of(atlas);
  require_values(atlas, curves, "stability", "the scene's compute.stability is off");
  const bool multipliers = holds_multipliers(atlas);
  const bool complex = archive::has_complex_stability(atlas.header());
  const auto pairs = static_cast<std::size_t>(atlas.header().pairs);
  const std::vector<double>& values = atlas.orbits().reals("stability");
  Figure figure{fmt::format("{}: stability", system_title(atlas)), abscissa.axis, {}};
  figure.y = multipliers
                 ? Axis{"modulus of the multipliers", Scale::logarithmic}
                 : Axis{complex ? "real part of the stability indices" : "stability index μ + 1/μ", Scale::squeezed};
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    const FamilyCurves::Number number = [&, pair](std::size_t orbit) {
      const std::size_t at = orbit * pairs + pair;
      if (!complex) return values[at];
      return multipliers ? std::hypot(values[2 * at], values[2 * at + 1]) : values[2 * at];
    };
    Figure of_pair = figure;
    of_pair.series.clear();
    of_pair.named.clear();
    add_families(of_pair, curves, curves.column(abscissa.column), number);
    figure.series.insert(figure.series.end(), of_pair.series.begin(), of_pair.series.end());
    if (pair == 0) figure.named = of_pair.named;
  }
  add_legend(figure, curves);
  const auto [low, high] = range_along(curves, abscissa.column);
  for (const double height : multipliers ? std::vector<double>{1.0} : std::vector<double>{-2.0, 2.0})
    add_level(figure, height, low, high);
  return figure;
}

}  // namespace orbweaver::report
