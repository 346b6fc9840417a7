#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::starts::table_one_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

double degrees_between(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square) / degree;
}

/// A step of some degrees of phase space along a direction, integrated for a period: how far it ends from its start.
double deviation(const systems::System& system, const std::vector<double>& point, const loop::Tangent& direction,
                 double period, double degrees = 0.5) {
  const loop::Loop loop = loop::moved(loop::constant_loop(point, period, 10), direction, degrees * degree);
  const std::vector<double> start = loop::state_at(loop, 0.0);
  EXPECT_NEAR(degrees_between(start, point), degrees, 1e-12);
  return degrees_between(certificate::integrate(system, start, period, 1e-14), start);
}

struct Row {
  test::PendulumMode mode;
  double paper;     ///< the paper's Table I, degrees
  double expected;  ///< with the refined period, degrees
};

class TableOne : public testing::TestWithParam<Row> {};

// With the exact period and eigenvector what is left is the nonlinearity of the orbit, of third order in the step.
TEST_P(TableOne, RefinedPeriodBeatsThePaper) {
  const auto& [mode, paper, expected] = GetParam();
  const auto system = systems::make_system("double_pendulum");
  const double grid_start = std::round(mode.period() * 10.0) / 10.0 - 0.2;
  const SweepResult result = sweep(*system, mode.point, {.period_from = grid_start, .period_to = grid_start + 0.4});
  ASSERT_EQ(result.modes.size(), 1u);
  const NormalMode& found = result.modes[0];
  const double refined = deviation(*system, mode.point, found.direction, found.period);
  const double on_grid = deviation(*system, mode.point, found.grid_direction, found.grid_period);
  std::cout << fmt::format("{:10} refined {:.3e}, on the grid (T = {:.2f}) {:.3e}, paper {:.3e} degrees\n", mode.name,
                           refined, found.grid_period, on_grid, paper);
  RecordProperty("refined_degrees", fmt::format("{:.6e}", refined));
  RecordProperty("grid_degrees", fmt::format("{:.6e}", on_grid));
  RecordProperty("paper_degrees", fmt::format("{:.6e}", paper));
  EXPECT_LT(refined, 0.3 * paper);
  EXPECT_NEAR(on_grid, paper, 0.01 * paper) << "the eigenvector and period of the grid give the paper's own row";
  EXPECT_NEAR(refined, expected, 0.01 * expected);

  // Half the step, an eighth of the deviation.
  EXPECT_NEAR(deviation(*system, mode.point, found.direction, found.period, 0.25), refined / 8.0, 0.01 * refined / 8.0);
}

INSTANTIATE_TEST_SUITE_P(Paper, TableOne,
                         testing::Values(Row{test::in_phase(), 1.76e-4, 5.657e-6},
                                         Row{test::out_phase(), 1.02e-3, 2.728e-4},
                                         Row{test::down_up(), 0.0982, 3.923e-4},
                                         Row{test::up_down(), 0.0976, 1.061e-3}),
                         [](const auto& tested) {
                           std::string name = tested.param.mode.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace orbweaver::starts::table_one_test
