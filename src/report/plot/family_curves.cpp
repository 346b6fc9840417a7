#include "plot/family_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/numerics/lagrange.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t family_colours = 6;  // of plot_colours: black and grey are for what belongs to no family
constexpr std::size_t points_an_interval = 8;
constexpr std::size_t orbits_of_a_polynomial = 4;

std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

/// Of each of the families drawn, the first of its ancestors among them; where parents go round in a circle, one of
/// them.
std::vector<std::size_t> first_ancestors(const std::vector<std::int64_t>& parents,
                                         const std::vector<std::size_t>& drawn) {
  std::vector<bool> is_drawn(parents.size());
  for (const std::size_t family : drawn) is_drawn[family] = true;
  constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> first(parents.size(), unknown);
  for (const std::size_t family : drawn) {
    std::vector<std::size_t> path;
    std::size_t at = family;
    while (first[at] == unknown) {
      first[at] = at;
      path.push_back(at);
      const std::int64_t parent = parents[at];
      if (parent >= 0 && is_drawn[static_cast<std::size_t>(parent)]) at = static_cast<std::size_t>(parent);
    }
    for (const std::size_t below : path) first[below] = first[at];
  }
  return first;
}

}  // namespace

double unplaced(Scale scale, double value) {
  switch (scale) {
    case Scale::linear: return value;
    case Scale::logarithmic: return std::pow(10.0, value);
    case Scale::squeezed: return 2.0 * std::sinh(value);
  }
  return value;
}

FamilyCurves::FamilyCurves(const archive::Archive& atlas, const std::vector<std::string>& families)
    : _atlas(atlas), _stability(atlas) {
  for (const std::string& family : families) _families.push_back(family_row(atlas, family));
  if (families.empty())
    for (std::size_t family = 0; family < atlas.families().rows(); ++family) _families.push_back(family);
  std::erase_if(_families, [&](std::size_t family) { return orbits_of(atlas, family).count == 0; });
  if (_families.empty())
    throw core::InputError(fmt::format("{} has no orbits to draw{}", atlas.path().string(),
                                       families.empty() ? "" : " in the families that were named"));
  _colour_of = _families.size() <= family_colours ? all_rows(atlas.families().rows())
                                                  : first_ancestors(atlas.families().integers("parent"), _families);
  for (const std::size_t family : _families)
    if (_colour_of[family] == family && _coloured.size() < family_colours) _coloured.push_back(family);
}

std::string FamilyCurves::colour(std::size_t family) const {
  const auto number =
      static_cast<std::size_t>(std::find(_coloured.begin(), _coloured.end(), _colour_of[family]) - _coloured.begin());
  return number < _coloured.size() ? plot_colours[number] : "#999999";
}

FamilyCurves::Number FamilyCurves::column(const char* name) const {
  const std::vector<double>& values = _atlas.orbits().reals(name);
  return [&values](std::size_t orbit) { return values[orbit]; };
}

Look FamilyCurves::look_of(std::size_t orbit) const {
  const std::optional<bool> is_stable = _stability.of(orbit);
  if (!is_stable) return Look::dotted;
  return *is_stable ? Look::solid : Look::dashed;
}

double FamilyCurves::change_between(std::size_t family, std::size_t orbit) const {
  const std::vector<double>& arclengths = _atlas.orbits().reals("arclength");
  const archive::Table& crossings = _atlas.crossings();
  for (std::size_t row = 0; row < crossings.rows(); ++row) {
    const double at = crossings.reals("arclength")[row];
    if (crossings.integers("family")[row] == static_cast<std::int64_t>(family) && at >= arclengths[orbit] &&
        at <= arclengths[orbit + 1] && !archive::is_fold(_atlas.crossing_kinds()[row]))
      return at;
  }
  return 0.5 * (arclengths[orbit] + arclengths[orbit + 1]);
}

std::vector<FamilyCurves::Sample> FamilyCurves::samples(std::size_t family, const Number& x, const Axis& x_axis,
                                                        const Number& y, const Axis& y_axis) const {
  const auto [first, count] = orbits_of(_atlas, family);
  const std::vector<double>& arclengths = _atlas.orbits().reals("arclength");
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::size_t n = 0; n < count; ++n) {
    xs.push_back(placed(x_axis.scale, x(first + n)));
    ys.push_back(placed(y_axis.scale, y(first + n)));
  }
  const auto point = [&](double u, double v) {
    return PlotPoint{unplaced(x_axis.scale, u), unplaced(y_axis.scale, v)};
  };
  std::vector<Sample> samples{{point(xs.front(), ys.front()), look_of(first)}};
  const std::size_t nodes = std::min(orbits_of_a_polynomial, count);
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const std::size_t begin = std::min(n > 0 ? n - 1 : 0, count - nodes);
    const std::span<const double> places(arclengths.data() + first + begin, nodes);
    const Look before = look_of(first + n);
    const Look after = look_of(first + n + 1);
    const double change = before == after ? arclengths[first + n + 1] : change_between(family, first + n);
    for (std::size_t k = 1; k <= points_an_interval; ++k) {
      const double part = static_cast<double>(k) / points_an_interval;
      const double at = (1.0 - part) * arclengths[first + n] + part * arclengths[first + n + 1];
      const std::vector<double> weights = numerics::lagrange_weights(places, at).value;
      double u = 0.0;
      double v = 0.0;
      for (std::size_t i = 0; i < nodes; ++i) {
        u += weights[i] * xs[begin + i];
        v += weights[i] * ys[begin + i];
      }
      samples.push_back({point(u, v), at <= change ? before : after});
    }
  }
  return samples;
}

std::vector<Series> FamilyCurves::drawn(std::size_t family, const Number& x, const Axis& x_axis, const Number& y,
                                        const Axis& y_axis) const {
  std::vector<Series> all;
  for (const Look look : {Look::solid, Look::dashed, Look::dotted}) {
    Series series{"", look, colour(family), {}};
    const std::vector<Sample> curve = samples(family, x, x_axis, y, y_axis);
    for (std::size_t n = 0; n < curve.size(); ++n) {
      if (curve[n].look == look) {
        if (n > 0 && curve[n - 1].look != look) series.points.push_back(curve[n - 1].point);  // no gap
        series.points.push_back(curve[n].point);
      } else if (!series.points.empty() && !std::isnan(series.points.back().x)) {
        series.points.push_back({no_value, no_value});
      }
    }
    if (!series.points.empty()) all.push_back(std::move(series));
  }
  return all;
}

NamedCurve FamilyCurves::named(std::size_t family, const Number& x, const Axis& x_axis, const Number& y,
                               const Axis& y_axis) const {
  NamedCurve curve{name(family), colour(family), {}};
  for (const Sample& sample : samples(family, x, x_axis, y, y_axis)) curve.points.push_back(sample.point);
  return curve;
}

}  // namespace orbweaver::report
