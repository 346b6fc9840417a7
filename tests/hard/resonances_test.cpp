// Equal and nearly equal normal modes, frequencies in the ratio 1:1, 1:2 and 1:3, exactly and off by 1e-6: as many
// families as shooting by extrapolation finds, each of them an orbit.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bifurcation/crossings.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "spectrum/point_systems.hpp"

namespace resonances_test {
namespace {

using namespace orbweaver;

using test::reference::Point;
using test::reference::Real;

/// H = (p1^2 + q1^2)/2 + w (p2^2 + q2^2)/2 + U, w = ratio (1 + detuning), with
///   1:1  U = (q1^4 + q2^4)/4 + 0.3 q1^2 q2^2/2      1:2  U = q1^2 q2      1:3  U = q1^3 q2 + q1^4/4;
/// state q1, q2, p1, p2.
class Resonant final : public test::PointSystem {
 public:
  Resonant(int ratio, double detuning) : PointSystem(described(ratio)), _ratio(ratio), _w(ratio * (1.0 + detuning)) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::Vector4d g = gradient_at(z);
    return Eigen::Vector4d(g[2], g[3], -g[0], -g[1]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const double x = z[0];
    const double y = z[1];
    Eigen::Matrix2d h;
    if (_ratio == 1)
      h << 3 * x * x + 0.3 * y * y, 0.6 * x * y, 0.6 * x * y, 3 * y * y + 0.3 * x * x;
    else if (_ratio == 2)
      h << 2 * y, 2 * x, 2 * x, 0;
    else
      h << 6 * x * y + 3 * x * x, 3 * x * x, 3 * x * x, 0;
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 2) = 1.0;
    a(1, 3) = _w;
    a.bottomLeftCorner<2, 2>() = -h;
    a(2, 0) -= 1.0;
    a(3, 1) -= _w;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    const auto [u, v] = slope(z[0], z[1]);
    return Eigen::Vector4d(z[0] + u, _w * z[1] + v, z[2], _w * z[3]);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    const double x = z[0];
    const double y = z[1];
    const double u = _ratio == 1   ? (std::pow(x, 4) + std::pow(y, 4)) / 4 + 0.15 * x * x * y * y
                     : _ratio == 2 ? x * x * y
                                   : x * x * x * y + std::pow(x, 4) / 4;
    return 0.5 * (x * x + z[2] * z[2] + _w * (y * y + z[3] * z[3])) + u;
  }

  /// The same law in long double.
  [[nodiscard]] Point<4> operator()(const Point<4>& z) const {
    const auto [u, v] = slope(z[0], z[1]);
    return {z[2], _w * z[3], -z[0] - u, -_w * z[1] - v};
  }

 private:
  template <class S>
  [[nodiscard]] std::pair<S, S> slope(S x, S y) const {
    if (_ratio == 1) return {x * x * x + S(0.3) * x * y * y, y * y * y + S(0.3) * y * x * x};
    if (_ratio == 2) return {2 * x * y, x * x};
    return {3 * x * x * y + x * x * x, x * x * x};
  }
  static systems::Structure described(int ratio) {
    systems::Structure d = test::structure_of(4, true, true);
    const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    const Eigen::Matrix4d mirror = ratio == 1   ? Eigen::Vector4d(-1, 1, -1, 1).asDiagonal().toDenseMatrix()
                                   : ratio == 2 ? Eigen::Vector4d(-1, 1, -1, 1).asDiagonal().toDenseMatrix()
                                                : Eigen::Vector4d(-1, -1, -1, -1).asDiagonal().toDenseMatrix();
    d.equivariances = {{"S", mirror}};
    d.reversors = {{"R", reverse}, {"RS", reverse * mirror}};
    return d;
  }
  int _ratio;
  double _w;
};

/// Orbits of the slow period that begin at rest at (r cos angle, r sin angle), angle in (-pi/2, pi/2), modulo nothing:
/// those along which both momenta vanish together half a period later. Changes of sign of p2 where p1 does.
int brake_orbits_by_shooting(const Resonant& system, double r) {
  constexpr int samples = 90;
  const auto left_over = [&](Real angle) {
    const Point<4> start{r * std::cos(angle), r * std::sin(angle), 0, 0};
    Real low = 0.94L * test::reference::pi;
    Real high = 1.06L * test::reference::pi;
    const Point<4> at_low = test::reference::flow(system, start, low, 1e-15L);
    const auto momentum = [&](Real time) { return test::reference::flow(system, at_low, time - low, 1e-15L); };
    const bool rises = momentum(high)[2] > 0;
    Point<4> here = at_low;
    Real from = low;
    Real to = high;
    for (int n = 0; n < 40; ++n) {
      const Real middle = (from + to) / 2;
      here = momentum(middle);
      ((here[2] > 0) == rises ? to : from) = middle;
    }
    return here[3];
  };
  int found = 0;
  Real before = 0;
  for (int n = 0; n <= samples; ++n) {
    const Real angle = test::reference::pi / 2 * (2 * (n + 0.4L) / (samples + 1) - 1) * 0.98L;
    const Real here = left_over(angle);
    if (n > 0 && here * before < 0) ++found;
    before = here;
  }
  return found;
}

struct Resonance {
  int ratio;
  double detuning;
};

class Resonances : public testing::TestWithParam<Resonance> {};

TEST_P(Resonances, AreFoundAsByShooting) {
  const auto [ratio, detuning] = GetParam();
  const std::string name = detuning == 0.0 ? fmt::format("1:{} resonance", ratio)
                                           : fmt::format("1:{} resonance, off by {:+.0e}", ratio, detuning);
  const auto system = std::make_shared<const Resonant>(ratio, detuning);
  const std::vector<double> origin(4, 0.0);
  constexpr double r = 0.05;
  constexpr double before_folds = 1e-4;
  starts::SweepOptions options = starts::automatic_range(starts::linear_modes(*system, origin));
  options.amplitude = 0.01;
  test::HardCase row(name, "brake orbits of the slow period by shooting");
  const bifurcation::SmallOscillations all =
      bifurcation::small_oscillations(*system, starts::sweep(*system, origin, options), 10);
  // Those that begin at rest with q1 > 0, their images under the mirror among them; where small oscillations start
  // apart, those that are born at the equilibrium: another one begins at a fold, where the amplitude is the root of the
  // detuning.
  int brake = 0;
  double worst = 0.0;
  double worst_period = 0.0;
  int slow = 0;
  for (const bifurcation::SmallOscillation& family : all.families) {
    const starts::NormalMode& mode = family.mode;
    continuation::Options steps;
    steps.energy_to = 0.5 * r * r;
    steps.start_amplitude = family.amplitude > 0.0 ? family.amplitude : 0.01;
    const test::Trace trace =
        test::trace_of(system, {loop::constant_loop(origin, mode.period, 10), mode.direction, mode.isotropy}, steps);
    ASSERT_EQ(trace.ending.reason, continuation::EndReason::energy_limit) << trace.ending.text();
    const loop::Loop& loop = trace.last().loop;
    const auto start = test::reference::point_of<4>(loop::state_at(loop, 0.0));
    const auto end = test::reference::flow(*system, start, loop.period);
    worst = test::worse(worst, static_cast<double>(test::reference::distance(start, end)) / r);
    if (mode.period < 1.5 * std::numbers::pi) continue;
    ++slow;
    worst_period = test::worse(worst_period, std::abs(loop.period / (2.0 * std::numbers::pi) - 1.0));
    const bool at_rest = std::hypot(start[2], start[3]) < 1e-9 * r;
    if (!at_rest || std::abs(start[0]) < 1e-6 * r) continue;  // the second motion alone is not among those shot
    const bool mirrored = ratio == 1 && std::abs(start[1]) > 1e-6 * r;
    brake += mirrored ? 2 : 1;
  }
  const int shot = brake_orbits_by_shooting(*system, all.kernels.empty() ? before_folds : r);
  row.is(brake == shot, fmt::format("{}", shot), fmt::format("{} of {} families", brake, slow));
  test::HardCase(name, "all close by extrapolation, relative").within(worst, 1e-9);
  EXPECT_LT(worst_period, 2.0 * r) << "of the order of the amplitude";
}

INSTANTIATE_TEST_SUITE_P(Hard, Resonances,
                         testing::Values(Resonance{1, 0.0}, Resonance{1, 1e-6}, Resonance{1, -1e-6}, Resonance{2, 0.0},
                                         Resonance{2, 1e-6}, Resonance{2, -1e-6}, Resonance{3, 0.0}, Resonance{3, 1e-6},
                                         Resonance{3, -1e-6}));

}  // namespace
}  // namespace resonances_test
