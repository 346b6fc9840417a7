#include "orbweaver/starts/fixed_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using numerics::two_pi;

constexpr double same_point = 1e-7;
/// Newton's step that no longer changes a point, and its field, relative to 1 + |df/dz|, that is rounding with room: a
/// start that leads elsewhere leaves a field of order 1.
constexpr double settled = 1e-15;
constexpr double vanishing_field = 1e-12;
constexpr int most_steps = 100;  // steps are bounded and may go round a saddle; otherwise a handful
constexpr double longest_step =
    1.0;  // of Newton, so that it does not leave the neighbourhood of its start for far away

void reduce_angles(const systems::System& system, Eigen::VectorXd& z) {
  for (const int i : system.structure().angles) {
    z(i) -= two_pi * std::floor(z(i) / two_pi);
    if (two_pi - z(i) < same_point) z(i) -= two_pi;
  }
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The phase of a drive turns whatever the rest does: it is held where it is.
void hold_phase(const systems::System& system, Eigen::VectorXd& f, RowMajor& a) {
  if (!system.structure().driven) return;
  const Eigen::Index last = f.size() - 1;
  f(last) = 0.0;
  a.row(last).setZero();
  a.col(last).setZero();
}

std::optional<Eigen::VectorXd> newton(const systems::System& system, Eigen::VectorXd z) {
  const Eigen::Index d = z.size();
  Eigen::VectorXd f(d);
  RowMajor a(d, d);
  for (int iteration = 0; iteration < most_steps; ++iteration) {
    system.field_jacobian(1, z.data(), f.data(), a.data());
    if (!f.allFinite() || !a.allFinite()) return std::nullopt;
    hold_phase(system, f, a);
    Eigen::VectorXd step = a.completeOrthogonalDecomposition().solve(f);
    if (step.norm() > longest_step) step *= longest_step / step.norm();
    z -= step;
    reduce_angles(system, z);
    if (step.norm() < settled * (1.0 + z.norm())) break;
  }
  system.field(1, z.data(), f.data());
  hold_phase(system, f, a);
  if (!(f.stableNorm() < vanishing_field * (1.0 + a.stableNorm()))) return std::nullopt;
  return z;
}

/// With the drive at zero the rest does not depend on its phase.
bool rests_at_all_phases(const systems::System& system, Eigen::VectorXd z) {
  if (!system.structure().driven) return true;
  constexpr int phases = 8;  // of a drive with a few harmonics
  const Eigen::Index d = z.size();
  Eigen::VectorXd f(d);
  RowMajor a(d, d);
  for (int n = 0; n < phases; ++n) {
    z(d - 1) = two_pi * n / phases;
    system.field_jacobian(1, z.data(), f.data(), a.data());
    hold_phase(system, f, a);
    if (!(f.stableNorm() < vanishing_field * (1.0 + a.stableNorm()))) return false;
  }
  return true;
}

bool is_finite_at(const systems::System& system, const Eigen::VectorXd& z) {
  const Eigen::Index d = z.size();
  Eigen::VectorXd f(d);
  Eigen::VectorXd jacobian(d * d);
  system.field_jacobian(1, z.data(), f.data(), jacobian.data());
  return f.allFinite() && jacobian.allFinite();
}

bool is_same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() < same_point * (1.0 + a.norm());
}

Eigen::VectorXd vector_of(std::span<const double> point) {
  return Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<Eigen::Index>(point.size()));
}

/// Values of one coordinate that differ by rounding count as one: mirror images may not change places.
void sort_by_coordinates(std::vector<std::vector<double>>& points) {
  using Ranked = std::pair<std::vector<int>, std::vector<double>>;
  std::vector<Ranked> ranked;
  for (std::vector<double>& point : points) ranked.push_back({{}, std::move(point)});
  const std::size_t d = ranked.empty() ? 0 : ranked.front().second.size();
  for (std::size_t i = 0; i < d; ++i) {
    std::vector<double> values;
    for (const Ranked& point : ranked) values.push_back(point.second[i]);
    std::sort(values.begin(), values.end());
    for (Ranked& point : ranked) {
      int rank = 0;
      for (std::size_t n = 1; n < values.size() && values[n] <= point.second[i]; ++n)
        if (values[n] - values[n - 1] > same_point * (1.0 + std::abs(values[n]))) ++rank;
      point.first.push_back(rank);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t n = 0; n < points.size(); ++n) points[n] = std::move(ranked[n].second);
}

[[noreturn]] void refuse_grid(const systems::System& system, const std::vector<double>& point) {
  std::vector<std::string> coordinates;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double told = point[i] * system.scales().coordinate(i);
    const bool angle = system.structure().is_angle(i);
    coordinates.push_back(fmt::format("{} = {:.6g}{}", system.info().state_names[i],
                                      angle ? told * 180.0 / std::numbers::pi : told, angle ? " deg" : ""));
  }
  throw core::InputError(
      fmt::format("starts.fixed_points.grid: expected a point where the vector field of {} and its derivatives are "
                  "finite, got none, the "
                  "first ({}); give other points or, beside starts that need no equilibrium, leave the grid out",
                  system.info().name, fmt::join(coordinates, ", ")));
}

}  // namespace

bool is_same_fixed_point(std::span<const double> a, std::span<const double> b) {
  return is_same(vector_of(a), vector_of(b));
}

std::optional<std::vector<double>> fixed_point_near(const systems::System& system, std::span<const double> start,
                                                    double within) {
  Eigen::VectorXd from = vector_of(start);
  reduce_angles(system, from);
  const std::optional<Eigen::VectorXd> point = newton(system, from);
  if (!point) return std::nullopt;
  Eigen::VectorXd away = *point - from;
  for (const int i : system.structure().angles) away(i) = std::remainder(away(i), two_pi);
  if (away.norm() > within) return std::nullopt;
  return std::vector<double>(point->begin(), point->end());
}

std::vector<std::vector<double>> find_fixed_points(const systems::System& system,
                                                   const std::vector<std::vector<double>>& grid,
                                                   std::vector<std::vector<double>>* not_finite) {
  const auto d = static_cast<std::size_t>(system.dimension());
  core::require(grid.size() <= d, "more grid lists than coordinates");
  std::size_t starts = 1;
  for (const std::vector<double>& values : grid) starts *= std::max<std::size_t>(values.size(), 1);
  std::vector<Eigen::VectorXd> found;
  std::vector<std::vector<double>> passed_over;
  for (std::size_t n = 0; n < starts; ++n) {
    core::interruption_point();
    Eigen::VectorXd z = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(d));
    std::size_t rest = n;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (grid[i].empty()) continue;
      z(static_cast<Eigen::Index>(i)) = grid[i][rest % grid[i].size()];
      rest /= grid[i].size();
    }
    if (!is_finite_at(system, z)) {
      passed_over.emplace_back(z.begin(), z.end());
      continue;
    }
    std::optional<Eigen::VectorXd> point = newton(system, std::move(z));
    if (!point || !rests_at_all_phases(system, *point)) continue;
    const bool known =
        std::any_of(found.begin(), found.end(), [&](const Eigen::VectorXd& w) { return is_same(w, *point); });
    if (!known) found.push_back(*point);
  }
  if (passed_over.size() == starts && !grid.empty()) refuse_grid(system, passed_over.front());
  if (not_finite != nullptr) *not_finite = std::move(passed_over);
  std::vector<std::vector<double>> points;
  for (const Eigen::VectorXd& z : found) points.emplace_back(z.begin(), z.end());
  sort_by_coordinates(points);
  return points;
}

}  // namespace orbweaver::starts
