// The cascade of the damped, driven double pendulum, against doublings that are located by integrations alone.
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "survey/atlas.hpp"

namespace cascade_test {
namespace {

using namespace orbweaver;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double tolerance = 1e-13;  // of integrations

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
    const auto d = static_cast<Eigen::Index>(state.size());
    for (int n = 0; n < most; ++n) {
      const std::vector<double> end = certificate::integrate(*system, state, _period, tolerance);
      const std::vector<double> flow = certificate::transitions(*system, {state}, _period, tolerance).front();
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const MatrixXd map = Eigen::Map<const RowMajor>(flow.data(), d, d).topLeftCorner(d - 1, d - 1);
      const MatrixXd one = MatrixXd::Identity(d - 1, d - 1);
      VectorXd gap(d - 1);
      for (Eigen::Index i = 0; i < d - 1; ++i) {
        const auto place = static_cast<std::size_t>(i);
        gap(i) = end[place] - state[place];
        if (system->structure().is_angle(place)) gap(i) = std::remainder(gap(i), 2.0 * std::numbers::pi);
      }
      const VectorXd step = (one - map).partialPivLu().solve(gap);
      for (Eigen::Index i = 0; i < d - 1; ++i) state[static_cast<std::size_t>(i)] += step(i);
      if (step.norm() < converged) return (one + map).determinant();
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
