#include "orbweaver/loop/grid/staggered_grid.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::staggered_grid_test {
namespace {

/// Isotropies with signs (S, R of the pendulum) and one that mixes coordinates (a threefold rotation with a mirror).
struct Case {
  std::string name;
  int dimension;
  Isotropy isotropy;
  int copies;
};

Isotropy of_pendulum(bool shift, bool reversor) {
  const Eigen::Matrix4d mirror = -Eigen::Matrix4d::Identity();
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  Isotropy out;
  if (shift) out.push_back({"S", false, mirror, 1, 2});
  if (reversor) out.push_back({"R", true, reverse, 0, 1});
  return out;
}

Case threefold() {
  const double c = std::cos(2.0 * std::numbers::pi / 3.0);
  const double s = std::sin(2.0 * std::numbers::pi / 3.0);
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner(2, 2) << c, -s, s, c;
  turn.bottomRightCorner(2, 2) = turn.topLeftCorner(2, 2);
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
  return {"threefold", 4, {{"C", false, turn, 1, 3}, {"M", true, reverse, 0, 1}}, 6};
}

Case sixfold() {
  Case out = threefold();
  return {"sixfold", 4, {{"S", false, -Eigen::Matrix4d::Identity(), 1, 2}, out.isotropy.front()}, 6};
}

class Staggered : public testing::TestWithParam<std::tuple<Case, int>> {
 protected:
  const Case& tested = std::get<0>(GetParam());
  FundamentalDomain domain = fundamental_domain(test::structure_of(tested.dimension), tested.isotropy);
  StaggeredGrid grid{domain, std::get<1>(GetParam())};

  /// Random modes of decreasing size with the symmetries, up to one below the grid's highest harmonic.
  [[nodiscard]] Loop sample() const {
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    Loop loop = constant_loop(std::vector<double>(static_cast<std::size_t>(tested.dimension), 0.0),
                              2.0 * std::numbers::pi, grid.cutoff() - 1);
    const Subspace subspace(tested.dimension, loop.cutoff, tested.isotropy);
    std::vector<double> coordinates(static_cast<std::size_t>(subspace.size()));
    for (int n = 0; n < subspace.size(); ++n)
      coordinates[static_cast<std::size_t>(n)] = normal(generator) / (1.0 + std::pow(subspace.harmonic(n), 1.5));
    subspace.add_to(coordinates, loop.modes);
    return loop;
  }
  [[nodiscard]] std::vector<double> nodal_of(const Loop& loop) const {
    std::vector<double> y(static_cast<std::size_t>(tested.dimension * grid.stride()));
    grid.from_modes(loop.cutoff, loop.modes.data(), y.data());
    return y;
  }
};

TEST_P(Staggered, CoversTheLoopWithCopies) {
  EXPECT_EQ(domain.copies(), tested.copies);
  EXPECT_EQ(grid.nodes(), tested.copies * grid.cells());
  EXPECT_TRUE(domain.is_square());
}

TEST_P(Staggered, ValuesAtMidpointsAndNodesAreTheLoops) {
  const Loop loop = sample();
  Loop slope = loop;  // dz/ds
  for (int k = 0; k <= loop.cutoff; ++k)
    for (int i = 0; i < loop.dimension; ++i) {
      slope.cosine(k, i) = k * (k == 0 ? 0.0 : loop.sine(k, i));
      if (k > 0) slope.sine(k, i) = -k * loop.cosine(k, i);
    }
  const std::vector<double> y = nodal_of(loop);
  std::vector<double> middle(y.size());
  std::vector<double> z(y.size());
  std::vector<double> dz(y.size());
  grid.to_midpoints(y.data(), middle.data());
  grid.at_nodes(y.data(), z.data(), dz.data());
  const double h = grid.spacing();
  const double rounding = 1e-14 * grid.nodes();
  for (int i = 0; i < loop.dimension; ++i)
    for (int j = 0; j <= grid.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * grid.stride() + j);
      const auto c = static_cast<std::size_t>(i);
      EXPECT_NEAR(z[n], state_at(loop, j * h)[c], rounding);
      EXPECT_NEAR(dz[n], state_at(slope, j * h)[c], rounding * grid.nodes());
      if (j == grid.cells()) continue;
      EXPECT_NEAR(middle[static_cast<std::size_t>(i * grid.cells() + j)], state_at(loop, (j + 0.5) * h)[c], rounding);
      EXPECT_NEAR((y[n + 1] - y[n]) / h, state_at(slope, (j + 0.5) * h)[c], rounding * grid.nodes())
          << "the difference of y is the derivative of z";
    }
}

TEST_P(Staggered, ModesComeBack) {
  const Loop loop = sample();
  const std::vector<double> y = nodal_of(loop);
  Loop back = with_cutoff(loop, grid.cutoff());
  grid.to_modes(y.data(), back.modes.data());
  EXPECT_LT(mean_distance(back, loop), 1e-14 * grid.nodes());
  std::vector<double> z(y.size());
  std::vector<double> dz(y.size());
  std::vector<double> again(y.size());
  grid.at_nodes(y.data(), z.data(), dz.data());
  grid.from_nodal(z.data(), again.data());
  for (int i = 0; i < loop.dimension; ++i)
    for (int j = 0; j <= grid.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * grid.stride() + j);
      EXPECT_NEAR(again[n], y[n], 1e-13 * grid.nodes());
    }
}

TEST_P(Staggered, EndsHoldForLoopsOfTheSubspace) {
  const std::vector<double> y = nodal_of(sample());
  const FundamentalDomain::Ends ends = domain.ends();
  for (Eigen::Index q = 0; q < ends.left.rows(); ++q) {
    double sum = 0.0;
    for (int i = 0; i < tested.dimension; ++i)
      sum += ends.left(q, i) * y[static_cast<std::size_t>(i * grid.stride())] +
             ends.right(q, i) * y[static_cast<std::size_t>(i * grid.stride() + grid.cells())];
    EXPECT_NEAR(sum, 0.0, 1e-13 * grid.nodes());
  }
}

// 12 and 64 cells multiply by matrices where the symmetries are signs, 200 transform.
INSTANTIATE_TEST_SUITE_P(
    Loop, Staggered,
    testing::Combine(testing::Values(Case{"none", 4, {}, 1}, Case{"shift", 4, of_pendulum(true, false), 2},
                                     Case{"mirror", 4, of_pendulum(false, true), 2},
                                     Case{"both", 4, of_pendulum(true, true), 4}, threefold(), sixfold()),
                     testing::Values(12, 64, 200)),
    [](const auto& tested) { return std::get<0>(tested.param).name + std::to_string(std::get<1>(tested.param)); });

TEST(Domain, ReversorsElsewhereAreNotUsed) {
  Isotropy isotropy = of_pendulum(false, true);
  isotropy[0].shift_numerator = 1;
  isotropy[0].shift_denominator = 4;
  EXPECT_EQ(fundamental_domain(test::structure_of(4), isotropy).copies(), 1);
}

TEST(Domain, KnowsWhatItDoesNotExpress) {
  for (const bool shift : {true, false})
    for (const bool reversor : {true, false}) {
      const Isotropy isotropy = of_pendulum(shift, reversor);
      EXPECT_TRUE(fundamental_domain(test::structure_of(4), isotropy).expresses(isotropy));
    }
  EXPECT_TRUE(fundamental_domain(test::structure_of(4), threefold().isotropy).expresses(threefold().isotropy));
  Isotropy elsewhere = of_pendulum(true, true);
  elsewhere[1].shift_numerator = 1;
  elsewhere[1].shift_denominator = 4;
  EXPECT_FALSE(fundamental_domain(test::structure_of(4), elsewhere).expresses(elsewhere));
  Isotropy spatial = of_pendulum(true, false);
  spatial[0].shift_numerator = 0;
  spatial[0].shift_denominator = 1;
  const FundamentalDomain kept = fundamental_domain(test::structure_of(4), spatial);
  EXPECT_TRUE(kept.expresses(spatial));
  ASSERT_TRUE(kept.projection);
  EXPECT_LT((*kept.projection - 0.5 * (Eigen::Matrix4d::Identity() + spatial[0].map.matrix)).norm(), 1e-15);
  EXPECT_FALSE(fundamental_domain(test::structure_of(4), of_pendulum(true, true)).projection);
}

TEST(Domain, TakesTheLeastShift) {
  Isotropy isotropy = threefold().isotropy;
  isotropy[0].shift_numerator = 2;  // C moves by two thirds of a period, so C^2 by one third
  const FundamentalDomain domain = fundamental_domain(test::structure_of(4), isotropy);
  EXPECT_LT((domain.generator - isotropy[0].map.matrix * isotropy[0].map.matrix).norm(), 1e-14);
}

TEST(Domain, TooFewCellsAreRefused) {
  EXPECT_THROW(StaggeredGrid(fundamental_domain(test::structure_of(2), {}), 1), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loop::staggered_grid_test
