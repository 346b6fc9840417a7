#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/continuation/sweep.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::continuation {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// How far from its start, in degrees of phase space, the trajectory is after one period: half a degree along a direction.
double deviation(const systems::System& system, const std::vector<double>& point, const std::vector<double>& direction, double period) {
  loop::Loop loop = loop::constant_loop(point, period, 10);
  for (std::size_t n = 0; n < direction.size(); ++n) loop.modes[n] += 0.5 * degree * direction[n];
  const std::vector<double> start = loop::state_at(loop, 0.0);
  double step = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) step += (start[i] - point[i]) * (start[i] - point[i]);
  EXPECT_NEAR(std::sqrt(step) / degree, 0.5, 1e-12);
  const std::vector<double> end = certificate::integrate(system, start, period, 1e-14);
  double square = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) square += (end[i] - start[i]) * (end[i] - start[i]);
  return std::sqrt(square) / degree;
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
  // The paper's grid: multiples of 0.01.
  const double grid_period = std::round(found.period * 100.0) / 100.0;
  const double on_grid = deviation(*system, mode.point, found.grid_direction, found.grid_period);
  const double on_paper_grid = deviation(*system, mode.point, found.direction, grid_period);
  std::cout << fmt::format("{:10}  refined {:.3e}  swept grid (T = {:.4f}) {:.3e}  paper's grid (T = {:.2f}) {:.3e}  paper {:.3e}\n", mode.name,
                           refined, found.grid_period, on_grid, grid_period, on_paper_grid, paper);
  RecordProperty("refined_degrees", fmt::format("{:.6e}", refined));
  RecordProperty("grid_degrees", fmt::format("{:.6e}", on_grid));
  RecordProperty("paper_degrees", fmt::format("{:.6e}", paper));
  EXPECT_LT(refined, 0.5 * paper);
  EXPECT_LT(refined, on_grid);
  EXPECT_GT(refined, expected / 1.2);
  EXPECT_LT(refined, expected * 1.2);

  // Half the step, an eighth of the deviation.
  loop::Loop half = loop::constant_loop(mode.point, found.period, 10);
  for (std::size_t n = 0; n < found.direction.size(); ++n) half.modes[n] += 0.25 * degree * found.direction[n];
  const std::vector<double> start = loop::state_at(half, 0.0);
  const std::vector<double> end = certificate::integrate(*system, start, found.period, 1e-14);
  double square = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) square += (end[i] - start[i]) * (end[i] - start[i]);
  EXPECT_NEAR(std::sqrt(square) / degree, refined / 8.0, 0.02 * refined / 8.0);
}

INSTANTIATE_TEST_SUITE_P(Paper, TableOne,
                         testing::Values(Row{test::in_phase(), 1.76e-4, 6e-6}, Row{test::out_phase(), 1.02e-3, 3e-4},
                                         Row{test::down_up(), 0.0982, 4e-4}, Row{test::up_down(), 0.0976, 1e-3}),
                         [](const auto& tested) {
                           std::string name = tested.param.mode.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace orbweaver::continuation
