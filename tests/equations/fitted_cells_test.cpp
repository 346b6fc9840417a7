#include "fitted_cells.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

namespace fitted_cells_test {
namespace {

using orbweaver::equations::fitted_cells;

/// (0, 1; -angle^2, 0): solutions turn by `angle` over a cell.
std::vector<double> turning(double angle) { return {0.0, 1.0, -angle * angle, 0.0}; }

/// The angle by which solutions of w (y_1 - y_0) = (B/2)(y_0 + y_1) turn, B = (0, b; c, 0).
double angle_of_scheme(const std::vector<double>& block, double w) {
  return 2.0 * std::atan(std::sqrt(-block[1] * block[2]) / (2.0 * w));
}

TEST(FittedCells, TurnAsTheFlowDoes) {
  for (const double w : {1.0, 3.0})
    for (const double angle : {0.8, 1.6, 2.4}) {
      SCOPED_TRACE(angle);
      std::vector<double> block = turning(angle);
      for (double& entry : block) entry *= w;
      EXPECT_GT(std::abs(angle_of_scheme(block, w) - angle), 0.03);  // what the plain scheme is off by
      const std::vector<double> fitted = fitted_cells(block.data(), 2, 1, w);
      ASSERT_EQ(fitted.size(), 4U);
      EXPECT_NEAR(angle_of_scheme(fitted, w), angle, 5e-3);
    }
}

TEST(FittedCells, AreLeftWhereThePlainSchemeFollowsAndWhereNoneDoes) {
  for (const double angle : {0.3, 4.0}) EXPECT_TRUE(fitted_cells(turning(angle).data(), 2, 1, 1.0).empty());
}

TEST(FittedCells, AreFittedOneByOne) {
  // Two cells of four coordinates: one turns by 0.2 and 1.5, the other by 0.2 twice.
  std::vector<double> blocks(32, 0.0);
  const auto set = [&](int cell, int row, int column, double value) {
    blocks[static_cast<std::size_t>((row * 4 + column) * 2 + cell)] = value;
  };
  for (const int cell : {0, 1}) {
    set(cell, 0, 1, 1.0);
    set(cell, 1, 0, -0.04);
    set(cell, 2, 3, 1.0);
    set(cell, 3, 2, cell == 0 ? -2.25 : -0.04);
  }
  const std::vector<double> fitted = fitted_cells(blocks.data(), 4, 2, 1.0);
  ASSERT_EQ(fitted.size(), blocks.size());
  for (std::size_t n = 1; n < blocks.size(); n += 2) EXPECT_EQ(fitted[n], blocks[n]);
  EXPECT_NEAR(angle_of_scheme({0.0, fitted[(2 * 4 + 3) * 2], fitted[(3 * 4 + 2) * 2], 0.0}, 1.0), 1.5, 3e-3);
  EXPECT_NEAR(angle_of_scheme({0.0, fitted[(0 * 4 + 1) * 2], fitted[(1 * 4 + 0) * 2], 0.0}, 1.0), 0.2, 1e-5);
}

}  // namespace
}  // namespace fitted_cells_test
