// Driven systems without friction: what their multipliers are, against integrations and Hill's equation.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"

namespace undamped_driven_test {
namespace {

using namespace orbweaver;

/// Duffing's oscillator under a drive of each amplitude up to where the family turns back.
scene::Scene driven_duffing() {
  return scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml",
      {"system={name: duffing, effects: [drive], parameters: {drive_amplitude: 0, drive_frequency: 0.8}}",
       "starts={fixed_points: {grid: [[0]]}}", "continuation.free=drive_amplitude", "limits.parameter=[0, 20]"});
}

constexpr double shaken_at = 1.6;  // rad/s

/// The hanging pendulum whose pivot goes up and down, and the families that leave it where it becomes unstable.
scene::Scene shaken_pendulum() {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
                     {"name=shaken",
                      "system={name: double_pendulum, effects: [pivot_drive], parameters: {pivot_amplitude: 0.1, "
                      "pivot_direction: 0, drive_frequency: 1.6}}",
                      "starts={fixed_points: {grid: [[0], [0]]}}", "continuation.free=pivot_amplitude",
                      "limits.parameter=[0, 0.5]", "survey.depth=1"});
}

/// Coefficients of det(x - M), the highest first, by Faddeev and LeVerrier.
std::vector<double> characteristic(const Eigen::MatrixXd& m) {
  std::vector<double> c{1.0};
  Eigen::MatrixXd n = Eigen::MatrixXd::Identity(m.rows(), m.rows());
  for (Eigen::Index k = 1; k <= m.rows(); ++k) {
    const Eigen::MatrixXd product = m * n;
    c.push_back(-product.trace() / static_cast<double>(k));
    n = product + c.back() * Eigen::MatrixXd::Identity(m.rows(), m.rows());
  }
  return c;
}

/// (x - 1), and x^2 - k x + 1 for each pair.
std::vector<double> one_and_pairs(const std::vector<std::complex<double>>& indices) {
  std::vector<std::complex<double>> c{1.0, -1.0};
  for (const std::complex<double>& k : indices) {
    std::vector<std::complex<double>> next(c.size() + 2);
    for (std::size_t n = 0; n < c.size(); ++n) {
      next[n] += c[n];
      next[n + 1] -= k * c[n];
      next[n + 2] += c[n];
    }
    c = std::move(next);
  }
  std::vector<double> reals;
  for (const std::complex<double>& v : c) reals.push_back(v.real());
  return reals;
}

std::vector<std::complex<double>> indices_of(const test::Atlas& atlas, std::size_t row, std::size_t pairs) {
  const std::vector<double>& columns = atlas.orbits().reals("stability");
  if (pairs == 1) return {columns[row]};
  std::vector<std::complex<double>> indices;
  for (std::size_t n = 0; n < pairs; ++n)
    indices.emplace_back(columns[2 * (row * pairs + n)], columns[2 * (row * pairs + n) + 1]);
  return indices;
}

/// The transition matrix of the period, integrated, has the multiplier 1 once, along the flow, and the pairs (rho,
/// 1/rho) of the archive; there is no second trivial one.
void expect_one_and_pairs(const test::Atlas& atlas, const systems::System& family, std::size_t pairs) {
  int alone = 0;
  for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
    SCOPED_TRACE(row);
    const loop::Loop loop = archive::loop_of(atlas, row, family.structure().angles);
    const std::vector<double> state = loop::state_at(loop, 0.0);
    const auto system = loop::system_at(family, loop);
    const auto d = static_cast<Eigen::Index>(state.size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const std::vector<double> entries = certificate::transitions(*system, {state}, loop.period, 1e-13).front();
    const Eigen::MatrixXd flow = Eigen::Map<const RowMajor>(entries.data(), d, d);
    Eigen::VectorXd along(d);
    system->field(1, state.data(), along.data());
    EXPECT_LT((flow * along - along).norm(), 1e-9 * flow.norm() * along.norm());
    const std::vector<std::complex<double>> indices = indices_of(atlas, row, pairs);
    const std::vector<double> found = characteristic(flow);
    const std::vector<double> claimed = one_and_pairs(indices);
    ASSERT_EQ(found.size(), claimed.size());
    for (std::size_t n = 0; n < found.size(); ++n)
      EXPECT_NEAR(found[n], claimed[n], 1e-9 * flow.squaredNorm()) << "coefficient " << n;
    const bool is_apart = std::all_of(indices.begin(), indices.end(),
                                      [](const std::complex<double>& k) { return std::abs(k - 2.0) > 0.1; });
    if (!is_apart) continue;
    ++alone;
    const Eigen::VectorXd singular =
        Eigen::JacobiSVD<Eigen::MatrixXd>(flow - Eigen::MatrixXd::Identity(d, d)).singularValues();
    EXPECT_LT(singular(d - 1), 1e-9 * flow.norm());
    EXPECT_GT(singular(d - 2), 1e-3) << "a second trivial multiplier";
  }
  EXPECT_GT(alone, 5);
}

void expect_nothing_conserved(const test::Atlas& atlas, const systems::Structure& structure) {
  EXPECT_EQ(structure.family_kind(), systems::FamilyKind::driven_undamped);
  EXPECT_TRUE(structure.symplectic);
  for (const double energy : atlas.orbits().reals("energy")) EXPECT_TRUE(std::isnan(energy));
}

std::string objections_to(const core::Communicator& comm, const survey::Summary& summary) {
  std::string text;
  for (const survey::Objection& o : survey::verify(comm, summary.atlas).objections)
    text += o.table + " " + std::to_string(o.row) + ": " + o.text + "\n";
  return text;
}

TEST(UndampedDriven, DuffingHasOneAndAPair) {
  const core::Communicator comm;
  const scene::Scene scene = driven_duffing();
  const survey::Summary summary = test::run(comm, scene, "duffing");
  EXPECT_EQ(objections_to(comm, summary), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const auto system = scene::bound_system(scene.system);
  ASSERT_EQ(system->structure().pairs(), 1);
  expect_nothing_conserved(atlas, system->structure());
  expect_one_and_pairs(atlas, *system, 1);
  // What would be conserved without the drive is not.
  double largest = 0.0;
  for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
    const loop::Loop loop = archive::loop_of(atlas, row, system->structure().angles);
    std::array<double, 2> energies{};
    for (std::size_t n = 0; n < 2; ++n) {
      const std::vector<double> z = loop::state_at(loop, 0.25 * static_cast<double>(n) * loop.period);
      energies[n] = 0.5 * z[1] * z[1] + 0.5 * z[0] * z[0] + 0.25 * std::pow(z[0], 4);
    }
    largest = std::max(largest, std::abs(energies[1] - energies[0]));
  }
  EXPECT_GT(largest, 1.0);
}

/// x'' + w^2 (1 - amplitude shaken_at^2 cos(shaken_at t)) x = 0, once around, by the classical Runge-Kutta method: the
/// trace. With all masses, lengths and gravity 1 the hanging pendulum's modes have w^2 = 2 -+ sqrt 2, and stay apart.
double hill_index(double square, double amplitude) {
  constexpr int steps = 4000;
  const double step = 2.0 * std::numbers::pi / shaken_at / steps;
  using State = std::array<double, 4>;  // two solutions with their rates
  const auto rate = [&](const State& s, double t) {
    const double stiffness = square * (1.0 - amplitude * shaken_at * shaken_at * std::cos(shaken_at * t));
    return State{s[1], -stiffness * s[0], s[3], -stiffness * s[2]};
  };
  const auto moved = [](State s, const State& k, double by) {
    for (std::size_t i = 0; i < 4; ++i) s[i] += by * k[i];
    return s;
  };
  State s{1.0, 0.0, 0.0, 1.0};
  for (int n = 0; n < steps; ++n) {
    const double t = n * step;
    const State a = rate(s, t);
    const State b = rate(moved(s, a, 0.5 * step), t + 0.5 * step);
    const State c = rate(moved(s, b, 0.5 * step), t + 0.5 * step);
    const State d = rate(moved(s, c, step), t + step);
    for (std::size_t i = 0; i < 4; ++i) s[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return s[0] + s[3];
}

// Along the first family the loops are the same but for the parameter.
TEST(UndampedDriven, ShakenPendulumHasOneAndTwoPairs) {
  constexpr double within = 1e-9;
  const core::Communicator comm;
  const scene::Scene scene = shaken_pendulum();
  const survey::Summary summary = test::run(comm, scene, "shaken");
  EXPECT_EQ(objections_to(comm, summary), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 3U)
      << "the rest to both sides, what doubles the drive's period, and what does not";
  const test::Atlas atlas(summary.atlas);
  const auto system = scene::bound_system(scene.system);
  ASSERT_EQ(system->structure().pairs(), 2);
  expect_nothing_conserved(atlas, system->structure());
  expect_one_and_pairs(atlas, *system, 2);
  const std::vector<double> amplitudes = atlas.column("parameter", "Equilibrium 1");
  for (std::size_t row = 0; row < amplitudes.size(); ++row) {
    std::vector<double> wanted{hill_index(2.0 - std::numbers::sqrt2, amplitudes[row]),
                               hill_index(2.0 + std::numbers::sqrt2, amplitudes[row])};
    std::vector<double> found;
    for (const std::complex<double>& k : indices_of(atlas, row, 2)) {
      EXPECT_NEAR(k.imag(), 0.0, within);
      found.push_back(k.real());
    }
    std::sort(wanted.begin(), wanted.end());
    std::sort(found.begin(), found.end());
    for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(found[n], wanted[n], within) << amplitudes[row];
  }
  std::set<std::string> kinds;
  for (std::size_t row = 1; row < 3; ++row) {
    const auto born = static_cast<std::size_t>(atlas.families().integers("crossing")[row]);
    const std::string kind = atlas.crossings().texts("kind")[born];
    kinds.insert(kind);
    const double index = kind == "branch-point" ? 2.0 : -2.0;
    const double amplitude = atlas.crossings().reals("parameter")[born];
    const double slow = hill_index(2.0 - std::numbers::sqrt2, amplitude);
    const double fast = hill_index(2.0 + std::numbers::sqrt2, amplitude);
    EXPECT_NEAR(std::min(std::abs(slow - index), std::abs(fast - index)), 0.0, within) << "the tongue's edge";
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"branch-point", "period-doubling"}));
}

}  // namespace
}  // namespace undamped_driven_test
