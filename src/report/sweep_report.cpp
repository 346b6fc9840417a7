#include "orbweaver/report/sweep_report.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "csv_text.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/starts/sampled_eigenvalues.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/survey/tasks/sweep_options.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "orbweaver/systems/identities.hpp"
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
  const auto cutoff = static_cast<int>(direction.modes.size() / d - 1) / 2;
  const loop::Loop change = loop::perturbation(loop::constant_loop(point, period, cutoff), direction);
  const std::vector<double> at_start = loop::state_at(change, 0.0);
  for (std::size_t i = 0; i < d; ++i) start[i] += step * at_start[i];
  const std::vector<double> end = certificate::integrate(system, start, period, certificate::Options{}.tolerance);
  double sum = 0.0;
  for (std::size_t i = 0; i < d; ++i) sum += (end[i] - start[i]) * (end[i] - start[i]);
  return std::sqrt(sum) / (angles ? degree : 1.0);
}

// The eigenvalues that do not oscillate.
std::string rest_text(const std::vector<std::complex<double>>& values) {
  std::string text;
  for (const std::complex<double>& value : values)
    text += fmt::format("{} {:.6g}{}", text.empty() ? ": eigenvalues" : ",", value.real(),
                        value.imag() == 0.0 ? "" : fmt::format(" {:+.6g}i", value.imag()));
  return text;
}

// Periods, eigenvalues of the Jacobian and the point; deviations and eigenvalues of the Hessian stay in scales.
void tell_in_units(EquilibriumReport& report, const systems::Scales& scales) {
  for (std::size_t i = 0; i < report.point.size(); ++i) report.point[i] *= scales.coordinate(i);
  starts::SweepResult& sweep = report.sweep;
  for (std::vector<starts::SweepPoint>* table : {&sweep.table, &report.odd})
    for (starts::SweepPoint& sample : *table) sample.period *= scales.time;
  for (starts::RejectedDip& dip : sweep.rejected) dip.period *= scales.time;
  for (std::complex<double>& value : sweep.linear.rest) value /= scales.time;
  for (double* period : {&sweep.range.period_from, &sweep.range.period_to, &sweep.range.step}) *period *= scales.time;
}

bool have_one_range(const std::vector<EquilibriumReport>& reports) {
  return std::all_of(reports.begin(), reports.end(), [&](const EquilibriumReport& r) {
    const starts::SweepOptions& first = reports.front().sweep.range;
    const starts::SweepOptions& here = r.sweep.range;
    return here.period_from == first.period_from && here.period_to == first.period_to && here.step == first.step;
  });
}

}  // namespace

std::vector<EquilibriumReport> sweep_report(const scene::Scene& scene) {
  const survey::ScaledScene scaled(scene, scene::bound_system(scene.system));
  const std::shared_ptr<const systems::System>& system = scaled.system();
  const double time = system->scales().time;
  std::vector<EquilibriumReport> reports;
  const std::vector<std::vector<double>> points = starts::find_fixed_points(*system, scaled.scene().fixed_points.grid);
  systems::require_identities(*system, points);
  for (const std::vector<double>& point : points) {
    const starts::SweepOptions options = survey::sweep_options(scaled.scene(), *system, point);
    EquilibriumReport report{point,
                             survey::point_text(*system, point),
                             system->structure().has_angles(),
                             starts::sweep(*system, point, options),
                             starts::sampled_eigenvalues(*system, point, options, starts::Harmonics::odd),
                             {},
                             {}};
    const auto name = [&](int place) {
      return survey::base_family_name(scaled.scene(), *system, point, static_cast<int>(reports.size()), place);
    };
    const bifurcation::SmallOscillations all = bifurcation::small_oscillations(*system, report.sweep, options.cutoff);
    for (const auto& family : all.families) {
      const starts::NormalMode& mode = family.mode;
      report.modes.push_back({name(family.place), mode.period * time, mode.grid_period * time,
                              deviation(*system, point, mode.direction, mode.period),
                              deviation(*system, point, mode.grid_direction, mode.grid_period),
                              loop::to_text(mode.isotropy)});
    }
    for (const bifurcation::LeftOut& left_out : all.left_out) {
      if (left_out.families == bifurcation::not_counted)
        report.left_out.push_back({"oscillations", left_out.period * time});
      for (int n = 0; n < left_out.families && !left_out.is_told; ++n)
        report.left_out.push_back({name(left_out.place + n), left_out.period * time});
    }
    for (const starts::RejectedDip& dip : all.without_family) report.sweep.rejected.push_back(dip);
    tell_in_units(report, system->scales());
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
    for (const LeftOutRow& m : r.left_out)
      text += fmt::format("  left out: {} with T = {:.15g}, outside the range [{:g}, {:g}]\n", m.name, m.period,
                          r.sweep.range.period_from, r.sweep.range.period_to);
    for (const starts::RejectedDip& dip : r.sweep.rejected)
      text += fmt::format("  dip at T = {:.9g}: {}\n", dip.period, dip.reason);
    text += fmt::format("  {}{}\n", starts::to_text(r.sweep.linear.stability), rest_text(r.sweep.linear.rest));
  }
  return text;
}

std::string eigenvalue_table(const std::vector<EquilibriumReport>& reports) {
  const bool shared = have_one_range(reports);
  std::string text;
  if (shared) text += fmt::format("{:>12}", "T");
  std::size_t rows = 0;
  for (std::size_t n = 0; n < reports.size(); ++n) {
    if (!shared) text += fmt::format("{}{:>12}", n == 0 ? "" : "  ", fmt::format("T_{}", n + 1));
    text += fmt::format("  {:>14}", fmt::format("lambda_{}", n + 1));
    rows = std::max(rows, reports[n].sweep.table.size());
  }
  text += "\n";
  for (std::size_t row = 0; row < rows; ++row) {
    if (shared) text += fmt::format("{:>12.6g}", reports.front().sweep.table[row].period);
    for (std::size_t n = 0; n < reports.size(); ++n) {
      const std::vector<starts::SweepPoint>& table = reports[n].sweep.table;
      const bool there = row < table.size();
      if (!shared)
        text += fmt::format("{}{:>12}", n == 0 ? "" : "  ", there ? fmt::format("{:.6g}", table[row].period) : "");
      text += fmt::format("  {:>14}", there ? fmt::format("{:.6e}", table[row].eigenvalue) : "");
    }
    text += "\n";
  }
  return text;
}

std::string eigenvalue_csv(const std::vector<EquilibriumReport>& reports) {
  const bool shared = have_one_range(reports);
  std::string text = shared ? "period" : "";
  std::size_t rows = 0;
  for (const EquilibriumReport& r : reports) {
    if (!shared) text += fmt::format("{}{}", text.empty() ? "" : ",", csv_text("period at " + r.text));
    text += "," + csv_text("smallest eigenvalue at " + r.text);
    rows = std::max(rows, r.sweep.table.size());
  }
  text += "\n";
  for (std::size_t row = 0; row < rows; ++row) {
    std::string line = shared ? fmt::format("{:.17g}", reports.front().sweep.table[row].period) : "";
    for (std::size_t n = 0; n < reports.size(); ++n) {
      const std::vector<starts::SweepPoint>& table = reports[n].sweep.table;
      const bool there = row < table.size();
      if (!shared)
        line += fmt::format("{}{}", n == 0 ? "" : ",", there ? fmt::format("{:.17g}", table[row].period) : "");
      line += there ? fmt::format(",{:.17g}", table[row].eigenvalue) : ",";
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace orbweaver::report
