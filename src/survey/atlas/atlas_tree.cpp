#include "orbweaver/survey/atlas/atlas_tree.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/archive/schema/schema.hpp"

namespace orbweaver::survey {

namespace {

/// Of the magnitude of an energy: what is lost in evaluating it.
constexpr double rounding = 1e-14;
/// A stability that is less certain says nothing (show_stability).
constexpr double largest_stability_error = 1e-3;

int as_int(std::int64_t value) { return static_cast<int>(value); }

// Sum of the stability values (their real parts) of one orbit: smooth along a family where single ones meet.
double stability_sum(const archive::Archive& atlas, std::size_t row) {
  const std::size_t width = archive::stability_width(atlas.header());
  const std::size_t parts = archive::has_complex_stability(atlas.header()) ? 2 : 1;
  double sum = width > 0 ? 0.0 : archive::not_computed;
  for (std::size_t i = 0; i < width; i += parts) sum += atlas.orbits().reals("stability")[row * width + i];
  return sum;
}

Invariants invariants_of(const archive::Archive& atlas, std::size_t row, double tolerance) {
  const archive::Table& orbits = atlas.orbits();
  const double period = orbits.reals("period")[row];
  const double energy = orbits.reals("energy")[row];
  const double action = orbits.reals("action")[row];
  const double parameter = orbits.reals("parameter")[row];
  const double sum = stability_sum(atlas, row);
  const double error = orbits.reals("stability_error")[row];
  const bool is_stability_known = !(error > largest_stability_error);
  const bool moves = !std::isnan(parameter);
  const double mean = std::isnan(action) || action == 0.0 ? std::abs(energy) : std::abs(action) / period;
  Invariants x;
  x.values = {period, moves ? parameter : energy, action, moves ? energy : archive::not_computed,
              is_stability_known ? std::asinh(0.5 * sum) : archive::not_computed};
  x.scale = {period, moves ? std::abs(parameter) : mean, std::abs(action), mean, 1.0};
  for (std::size_t i = 0; i < x.floor.size(); ++i)
    x.floor[i] = tolerance * x.scale[i] + rounding * std::abs(x.values[i]);
  // d asinh(k/2) = dk / sqrt(4 + k^2)
  const double error_of_trace = std::isnan(error) ? 0.0 : error / std::sqrt(4.0 + sum * sum);
  x.floor.back() = tolerance + error_of_trace;
  return x;
}

// Action/period passes 0 where the action does, and a parameter may: levels then count in what they change from orbit
// to orbit.
void widen_level_scales(std::vector<Invariants>& points, double tolerance) {
  constexpr auto level = static_cast<std::size_t>(Invariant::level);
  for (std::size_t n = 0; n < points.size(); ++n)
    for (const std::size_t beside : {n > 0 ? n - 1 : n, n + 1 < points.size() ? n + 1 : n}) {
      const double change = std::abs(points[n].values[level] - points[beside].values[level]);
      points[n].scale[level] = std::fmax(points[n].scale[level], change);
      points[n].floor[level] = std::fmax(points[n].floor[level], tolerance * change);
    }
}

double apart_less(const TreeCrossing& x, const TreeCrossing& y, double period, double level) {
  const double in_period = (std::abs(x.period - y.period) - period) / x.period;
  const double in_level = (std::abs(x.level - y.level) - level) / x.level_scale;
  return std::fmax(std::fmax(in_period, in_level), 0.0);
}

std::vector<FamilyEnd> ends_of(const std::string& reason, const std::vector<std::int64_t>& steps, std::size_t first,
                               std::size_t count) {
  const std::vector<EndKind> kinds = ends_in(reason);
  const std::size_t last = count > 0 ? count - 1 : 0;
  if (kinds.size() == 2) return {{last, kinds[0]}, {0, kinds[1]}};
  const bool runs_backwards = count > 0 && steps[first] < 0 && steps[first + last] < 0;
  return {{runs_backwards ? 0 : last, kinds.front()}};
}

}  // namespace

AtlasTree::AtlasTree(const archive::Archive& archive, double tolerance) : atlas(archive) {
  parameter = atlas.moving_parameter();
  const archive::Table& table = atlas.families();
  families.resize(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    TreeFamily& family = families[row];
    family.name = table.texts("name")[row];
    family.parent = as_int(table.integers("parent")[row]);
    family.crossing = as_int(table.integers("crossing")[row]);
    family.multiplicity = as_int(table.integers("multiplicity")[row]);
    family.birth_arclength = table.reals("birth_arclength")[row];
    family.isotropy = table.texts("isotropy")[row];
    family.end_family = as_int(table.integers("end_family")[row]);
    family.end_crossing = as_int(table.integers("end_crossing")[row]);
    family.first_orbit = static_cast<std::size_t>(table.integers("first_orbit")[row]);
    const auto count = static_cast<std::size_t>(table.integers("orbit_count")[row]);
    std::vector<Invariants> points;
    points.reserve(count);
    for (std::size_t i = family.first_orbit; i < family.first_orbit + count; ++i) {
      points.push_back(invariants_of(atlas, i, tolerance));
      family.arclengths.push_back(atlas.orbits().reals("arclength")[i]);
    }
    widen_level_scales(points, tolerance);
    family.curve = InvariantCurve(std::move(points));
    family.ends = ends_of(table.texts("end_reason")[row], atlas.orbits().integers("step"), family.first_orbit, count);
    if (family.parent < 0) roots.push_back(static_cast<int>(row));
  }
  const archive::Table& events = atlas.crossings();
  crossings.resize(events.rows());
  for (std::size_t row = 0; row < events.rows(); ++row) {
    TreeCrossing& crossing = crossings[row];
    crossing.kind = events.texts("kind")[row];
    crossing.family = as_int(events.integers("family")[row]);
    crossing.multiplicity = as_int(events.integers("multiplicity")[row]);
    crossing.kernel_dimension = as_int(events.integers("kernel_dimension")[row]);
    crossing.sector_j = as_int(events.integers("sector_j")[row]);
    crossing.sector_q = as_int(events.integers("sector_q")[row]);
    crossing.fundamental_order = as_int(events.integers("fundamental_order")[row]);
    crossing.period = events.reals("period")[row];
    crossing.parameter = parameter;
    crossing.level = events.reals(in_parameter() ? "parameter" : "energy")[row];
    const auto known = [&](const char* column) { return std::fmax(0.0, events.reals(column)[row]); };
    crossing.place_error = known("place_error");
    crossing.place_error_period = known("place_error_period");
    crossing.place_error_level = known(in_parameter() ? "place_error_parameter" : "place_error_energy");
    TreeFamily& owner = families[static_cast<std::size_t>(crossing.family)];
    owner.crossings.push_back(static_cast<int>(row));
    const auto after =
        std::lower_bound(owner.arclengths.begin(), owner.arclengths.end(), events.reals("arclength")[row]);
    if (owner.orbits() == 0) continue;
    const auto nearest =
        std::min<std::size_t>(static_cast<std::size_t>(after - owner.arclengths.begin()), owner.orbits() - 1);
    crossing.level_scale = owner.curve.points()[nearest].scale_of(Invariant::level);
  }
  for (std::size_t row = 0; row < families.size(); ++row)
    if (families[row].crossing >= 0)
      crossings[static_cast<std::size_t>(families[row].crossing)].children.push_back(static_cast<int>(row));
}

std::size_t AtlasTree::first_step_of(const TreeFamily& family) const {
  const auto& steps = atlas.orbits().integers("step");
  std::size_t first = 0;
  for (std::size_t n = 0; n < family.orbits(); ++n)
    if (std::abs(steps[family.first_orbit + n]) < std::abs(steps[family.first_orbit + first])) first = n;
  return first;
}

double apart(const TreeCrossing& x, const TreeCrossing& y) { return apart_less(x, y, 0.0, 0.0); }

double apart_beyond_errors(const TreeCrossing& x, const TreeCrossing& y) {
  return apart_less(x, y, x.place_error_period + y.place_error_period, x.place_error_level + y.place_error_level);
}

std::string place_text(const TreeCrossing& crossing) {
  const std::string level =
      crossing.parameter.empty() ? "" : fmt::format(", {} {:.6g}", crossing.parameter, crossing.level);
  return fmt::format("{} T {:.6g}{}", crossing.kind, crossing.period, level);
}

}  // namespace orbweaver::survey
