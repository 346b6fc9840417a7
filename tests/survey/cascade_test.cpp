// The cascade of the damped, driven double pendulum, against doublings that are located by integrations alone.
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/certificate/integrate.hpp"
#include "survey/atlas.hpp"

namespace cascade_test {
namespace {

using namespace orbweaver;
using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;  // rows

constexpr double tolerance = 1e-13;  // of integrations

/// Gauss's elimination: of m and x, which becomes m^-1 x; the determinant of m. By hand, since a decomposition of Eigen
/// that is compiled here may be taken for the libraries' own (cmake/Tests.cmake).
double eliminate(Matrix m, Vector& x) {
  double determinant = 1.0;
  for (std::size_t k = 0; k < m.size(); ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < m.size(); ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    if (pivot != k) {
      std::swap(m[k], m[pivot]);
      std::swap(x[k], x[pivot]);
      determinant = -determinant;
    }
    determinant *= m[k][k];
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i == k) continue;
      const double factor = m[i][k] / m[k][k];
      for (std::size_t l = k; l < m.size(); ++l) m[i][l] -= factor * m[k][l];
      x[i] -= factor * x[k];
    }
  }
  for (std::size_t k = 0; k < m.size(); ++k) x[k] /= m[k][k];
  return determinant;
}

/// What `turns` periods of the drive do to the other coordinates, the drive's phase being the same again.
class Strobe {
 public:
  Strobe(std::shared_ptr<const systems::System> system, int turns)
      : _system(std::move(system)),
        _period(2.0 * std::numbers::pi * turns / _system->parameters().at("drive_frequency")) {}

  [[nodiscard]] double period() const { return _period; }

  /// det(1 + M) of the orbit that Newton's method finds from `state`, which becomes that orbit's, at this amplitude.
  [[nodiscard]] double distance_of_multipliers(double amplitude, std::vector<double>& state) const {
    constexpr int most = 12;
    constexpr double converged = 1e-9;  // quadratically: what is left is rounding, which the doubled orbits amplify
    std::map<std::string, double> values = _system->parameters();
    values["torque1_amplitude"] = amplitude;
    const std::shared_ptr<const systems::System> system = _system->with_parameters(values);
    const std::size_t d = state.size();
    for (int n = 0; n < most; ++n) {
      const Vector end = certificate::integrate(*system, state, _period, tolerance);
      const Vector flow = certificate::transitions(*system, {state}, _period, tolerance).front();
      Matrix returns(d - 1, Vector(d - 1));  // 1 - M
      Matrix doubles(d - 1, Vector(d - 1));  // 1 + M
      Vector step(d - 1);
      for (std::size_t i = 0; i + 1 < d; ++i) {
        for (std::size_t l = 0; l + 1 < d; ++l) {
          const double one = i == l ? 1.0 : 0.0;
          returns[i][l] = one - flow[i * d + l];
          doubles[i][l] = one + flow[i * d + l];
        }
        step[i] = end[i] - state[i];
        if (system->structure().is_angle(i)) step[i] = std::remainder(step[i], 2.0 * std::numbers::pi);
      }
      (void)eliminate(returns, step);
      double square = 0.0;
      for (std::size_t i = 0; i + 1 < d; ++i) {
        state[i] += step[i];
        square += step[i] * step[i];
      }
      if (std::sqrt(square) < converged) return eliminate(doubles, step);
    }
    ADD_FAILURE() << "no orbit of T = " << _period << " at " << amplitude;
    return std::nan("");
  }

 private:
  std::shared_ptr<const systems::System> _system;
  double _period;
};

/// Where a multiplier is -1, by the secant method from `near`.
double doubling_near(const Strobe& strobe, double near, std::vector<double> state) {
  constexpr double beside = 1e-8;  // of the orbits doubled twice Newton's method finds none from 1e-6 beside
  double before = near + beside;
  double here = near - beside;
  double value_before = strobe.distance_of_multipliers(before, state);
  for (int n = 0; n < 8 && std::abs(here - before) > 1e-13; ++n) {
    const double value = strobe.distance_of_multipliers(here, state);
    const double next = here - value * (here - before) / (value - value_before);
    before = here;
    value_before = value;
    here = next;
  }
  return here;
}

TEST(Cascade, DoublesThreeTimesWhereIntegrationsDo) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/damped_driven_double_pendulum.yaml", {});
  const survey::Summary summary = test::run(comm, scene, "cascade");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  const test::Atlas atlas(summary.atlas);
  const archive::Table& crossings = atlas.crossings();
  const std::vector<std::string> families{"Strong", "Strong D", "Strong DD"};
  std::vector<double> doublings;
  for (std::size_t n = 0; n < families.size(); ++n) {
    SCOPED_TRACE(families[n]);
    const Strobe strobe(scene::bound_system(scene.system), 1 << n);
    const auto row = atlas.crossing(families[n], "period-doubling", strobe.period());
    ASSERT_TRUE(row);
    const auto state = crossings.reals("state").begin() + static_cast<std::ptrdiff_t>(5 * *row);
    const double found = crossings.reals("parameter")[*row];
    EXPECT_NEAR(doubling_near(strobe, found, {state, state + 5}), found, 1e-9);
    doublings.push_back(found);
  }
  EXPECT_NEAR(doublings[0], 1.421973053, 1e-9);
  EXPECT_NEAR(doublings[1], 1.424459538, 1e-9);
  EXPECT_NEAR(doublings[2], 1.424586333, 1e-9);
  EXPECT_NEAR((doublings[1] - doublings[0]) / (doublings[2] - doublings[1]), 19.61, 0.005);
}

}  // namespace
}  // namespace cascade_test
