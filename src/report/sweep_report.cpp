#include "orbweaver/report/sweep_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::report {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double table_step = 0.5 * degree;  // the paper's
constexpr double plain_step = 0.01;          // about as long, where there are no degrees

// How far the flow returns beside its start after a small step along a direction of unit length at s = 0.
double deviation(const systems::System& system, const std::vector<double>& point, const loop::Tangent& direction,
                 double period) {
  const bool angles = system.structure().has_angles();
  const double step = angles ? table_step : plain_step;
  std::vector<double> start = point;
  const std::size_t d = point.size();
  for (std::size_t i = 0; i < d; ++i)
    start[i] += step * direction.modes[d + i];  // a_1: the only cosine of a normal mode
  const std::vector<double> end = certificate::integrate(system, start, period, certificate::Options{}.tolerance);
  double sum = 0.0;
  for (std::size_t i = 0; i < d; ++i) sum += (end[i] - start[i]) * (end[i] - start[i]);
  return std::sqrt(sum) / (angles ? degree : 1.0);
}

}  // namespace

std::vector<EquilibriumReport> sweep_report(const scene::Scene& scene) {
  const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  starts::SweepOptions options;
  options.period_from = scene.sweep.period_from;
  options.period_to = scene.sweep.period_to;
  options.step = scene.sweep.step;
  std::vector<EquilibriumReport> reports;
  for (const std::vector<double>& point : starts::find_fixed_points(*system, scene.fixed_points.grid)) {
    EquilibriumReport report{point,
                             survey::point_text(*system, point),
                             system->structure().has_angles(),
                             starts::sweep(*system, point, options),
                             {}};
    for (const starts::NormalMode& mode : bifurcation::small_oscillations(*system, report.sweep, options.cutoff))
      report.modes.push_back({survey::base_family_name(scene, *system, point, static_cast<int>(reports.size()),
                                                       static_cast<int>(report.modes.size())),
                              mode.period, mode.grid_period, deviation(*system, point, mode.direction, mode.period),
                              deviation(*system, point, mode.grid_direction, mode.grid_period),
                              loop::to_text(mode.isotropy)});
    reports.push_back(std::move(report));
  }
  return reports;
}

std::string to_text(const std::vector<EquilibriumReport>& reports) {
  std::size_t width = 6;
  for (const EquilibriumReport& r : reports)
    for (const ModeRow& m : r.modes) width = std::max(width, m.name.size());
  const bool degrees = reports.empty() || reports.front().angles;
  std::string text = fmt::format(
      "Normal modes; deviation: how far the flow returns from its start{} along the mode\n",
      degrees ? ", in degrees, after a step of 0.5 degrees" : fmt::format(" after a step of {}", plain_step));
  for (const EquilibriumReport& r : reports) {
    text += fmt::format("\n{}\n", r.text);
    if (r.modes.empty())
      text += fmt::format("  no small oscillations for T in [{:g}, {:g}]\n", r.sweep.table.front().period,
                          r.sweep.table.back().period);
    else
      text += fmt::format("  {:<{}}  {:>18}  {:>9}  {:>11}  {:>8}  {:>11}  {}\n", "family", width, "period",
                          "deviation", "grid period", "", "deviation", "isotropy");
    for (const ModeRow& m : r.modes)
      text += fmt::format("  {:<{}}  {:>18.15g}  {:>9.2e}  {:>11.6g}  {:>8}  {:>11.2e}  {}\n", m.name, width, m.period,
                          m.deviation, m.grid_period, "", m.grid_deviation, m.isotropy);
    for (const starts::RejectedDip& dip : r.sweep.rejected)
      text += fmt::format("  dip at T = {:.9g}: {}\n", dip.period, dip.reason);
  }
  return text;
}

std::string eigenvalue_table(const std::vector<EquilibriumReport>& reports) {
  std::string text = fmt::format("{:>12}", "T");
  for (std::size_t n = 0; n < reports.size(); ++n) text += fmt::format("  {:>14}", fmt::format("lambda_{}", n + 1));
  text += "\n";
  if (reports.empty()) return text;
  for (std::size_t row = 0; row < reports.front().sweep.table.size(); ++row) {
    text += fmt::format("{:>12.6g}", reports.front().sweep.table[row].period);
    for (const EquilibriumReport& r : reports) text += fmt::format("  {:>14.6e}", r.sweep.table[row].eigenvalue);
    text += "\n";
  }
  return text;
}

std::string eigenvalue_csv(const std::vector<EquilibriumReport>& reports) {
  std::string text = "period";
  for (const EquilibriumReport& r : reports) text += fmt::format(",\"smallest eigenvalue at {}\"", r.text);
  text += "\n";
  if (reports.empty()) return text;
  for (std::size_t row = 0; row < reports.front().sweep.table.size(); ++row) {
    text += fmt::format("{:.17g}", reports.front().sweep.table[row].period);
    for (const EquilibriumReport& r : reports) text += fmt::format(",{:.17g}", r.sweep.table[row].eigenvalue);
    text += "\n";
  }
  return text;
}

}  // namespace orbweaver::report
