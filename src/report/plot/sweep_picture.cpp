#include "plot/sweep_picture.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/report/sweep_report.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "plot/axis_titles.hpp"
#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

bool begins_at(const EquilibriumReport& report, const std::string& family) {
  return std::any_of(report.modes.begin(), report.modes.end(), [&](const ModeRow& m) { return m.name == family; });
}

std::vector<EquilibriumReport> asked_for(const archive::Archive& atlas, const PlotRequest& request) {
  std::vector<EquilibriumReport> all = sweep_report(survey::scene_of(atlas));
  if (all.empty())
    throw core::InputError(
        fmt::format("{} has no sweep to draw: its scene leads to no equilibrium", atlas.path().string()));
  for (const std::string& family : request.families) {
    static_cast<void>(family_row(atlas, family));
    if (std::none_of(all.begin(), all.end(), [&](const EquilibriumReport& r) { return begins_at(r, family); }))
      throw core::InputError(fmt::format("{} has no sweep of `{}`: it begins at no equilibrium of the scene's",
                                         atlas.path().string(), family));
  }
  if (!request.families.empty())
    std::erase_if(all, [&](const EquilibriumReport& r) {
      return std::none_of(request.families.begin(), request.families.end(),
                          [&](const std::string& family) { return begins_at(r, family); });
    });
  return all;
}

/// "th1 = 0, th2 = 180 deg": the configuration, where nothing moves.
std::string place_of(const archive::Archive& atlas, const EquilibriumReport& report) {
  const std::size_t d = report.point.size();
  const auto moves = [](double velocity) { return std::abs(velocity) > 1e-9; };
  if (d < 4 || d % 2 != 0 ||
      std::any_of(report.point.begin() + static_cast<std::ptrdiff_t>(d / 2), report.point.end(), moves))
    return report.text;
  const std::vector<int> angles = angles_of(atlas);
  std::string text;
  for (std::size_t i = 0; i < d / 2; ++i) {
    const bool is_angle = std::find(angles.begin(), angles.end(), static_cast<int>(i)) != angles.end();
    text += fmt::format("{}{} = {:.4g}{}", i == 0 ? "" : ", ", atlas.header().state_names[i],
                        report.point[i] * (is_angle ? 180.0 / std::numbers::pi : 1.0), is_angle ? "°" : "");
  }
  return text;
}

/// Points between those of a curve that falls steeply, so that names see it.
std::vector<PlotPoint> denser(const std::vector<PlotPoint>& points) {
  constexpr int parts = 6;
  std::vector<PlotPoint> all;
  for (std::size_t n = 0; n + 1 < points.size(); ++n)
    for (int part = 0; part < parts; ++part) {
      const double u = static_cast<double>(part) / parts;
      all.push_back({(1.0 - u) * points[n].x + u * points[n + 1].x,
                     std::pow(points[n].y, 1.0 - u) * std::pow(points[n + 1].y, u)});
    }
  return all;
}

std::vector<PlotPoint> points_of(const std::vector<starts::SweepPoint>& table) {
  std::vector<PlotPoint> points;
  for (const starts::SweepPoint& sample : table) points.push_back({sample.period, sample.eigenvalue});
  return points;
}

/// The names of oscillations, below their dips.
void add_names(Figure& figure, const EquilibriumReport& report, const std::string& colour) {
  for (const ModeRow& mode : report.modes)
    for (const starts::SweepPoint& sample : report.sweep.table)
      if (sample.period == mode.grid_period)
        figure.named.push_back(
            {fmt::format("{} {:.5g}", mode.name, mode.period), colour, {{sample.period, sample.eigenvalue}}});
}

}  // namespace

Figure sweep_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const std::vector<EquilibriumReport> reports = asked_for(atlas, request);
  Figure figure{fmt::format("{}: sweep", system_title(atlas)),
                {period_title(atlas)},
                {"smallest eigenvalue", Scale::logarithmic}};
  if (reports.size() == 1) {
    figure.series.push_back({"all harmonics", Look::solid, plot_colours[0], points_of(reports.front().sweep.table)});
    figure.series.push_back({"odd harmonics only", Look::dashed, plot_colours[1], points_of(reports.front().odd)});
  } else {
    constexpr Look looks[] = {Look::solid, Look::dashed, Look::dotted};
    for (std::size_t n = 0; n < reports.size(); ++n)
      figure.series.push_back({place_of(atlas, reports[n]), looks[n % std::size(looks)],
                               plot_colours[n % plot_colours.size()], points_of(reports[n].sweep.table)});
  }
  for (const Series& series : figure.series) figure.named.push_back({"", series.colour, denser(series.points)});
  for (std::size_t n = 0; n < reports.size(); ++n)
    add_names(figure, reports[n], reports.size() == 1 ? "#000000" : plot_colours[n % plot_colours.size()]);
  return figure;
}

}  // namespace orbweaver::report
