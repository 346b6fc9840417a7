#include "orbweaver/loop/grid/fourier.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::loop::fourier_test {
namespace {

using test::random_loop;
using test::random_values;
using test::two_pi;

bool has_only_factors_2_3_5_7(int n) {
  for (const int p : {2, 3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

TEST(FourierGrid, NodesAreTheSmallestGoodNumberThatIntegratesTheLoss) {
  for (int k = 1; k <= 600; ++k) {
    const int n = FourierGrid::nodes_for(k);
    EXPECT_EQ(n % 2, 0);
    EXPECT_TRUE(has_only_factors_2_3_5_7(n)) << n;
    ASSERT_GE(n, 2 * (2 * k + 1));
    for (int smaller = 2 * (2 * k + 1); smaller < n; smaller += 2) EXPECT_FALSE(has_only_factors_2_3_5_7(smaller));
  }
  // For the cutoffs in use nothing is added.
  for (int k = 7; k < 5000; k = next_cutoff(k)) EXPECT_EQ(FourierGrid::nodes_for(k), 2 * (2 * k + 1));
}

TEST(FourierGrid, IsMadeOnceASize) {
  EXPECT_EQ(&FourierGrid::of_size(30), &FourierGrid::of_size(30));
  EXPECT_NE(&FourierGrid::of_size(30), &FourierGrid::of_size(32));
  EXPECT_EQ(FourierGrid::of_size(30).nodes(), 30);
}

TEST(FourierGrid, SynthesizesStatesAndSlopes) {
  for (const auto& [cutoff, nodes] : {std::pair{1, 3}, {1, 4}, {4, 9}, {4, 10}, {7, 30}, {22, 45}, {31, 64}}) {
    const Loop loop = random_loop(3, cutoff, 21, 1.0, 0.95);
    const FourierGrid& grid = FourierGrid::of_size(nodes);
    const auto n = static_cast<std::size_t>(nodes);
    std::vector<double> state(3 * n);
    std::vector<double> slope(3 * n);
    grid.synthesize(cutoff, 3, loop.modes.data(), state.data());
    grid.synthesize_derivative(cutoff, 3, loop.modes.data(), slope.data());
    for (std::size_t j = 0; j < n; ++j) {
      const test::Direct expected = test::direct_sum(loop, two_pi * static_cast<double>(j) / nodes);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(state[i * n + j], expected.state[i], 1e-13);
        EXPECT_NEAR(slope[i * n + j], expected.slope[i], 1e-12);
      }
    }
  }
}

TEST(FourierGrid, AnalyzesWhatItSynthesized) {
  for (const auto& [cutoff, nodes] : {std::pair{1, 3}, {1, 4}, {4, 9}, {4, 10}, {7, 30}, {22, 45}, {31, 64}}) {
    const Loop loop = random_loop(2, cutoff, 22, 1.0, 0.95);
    const FourierGrid& grid = FourierGrid::of_size(nodes);
    std::vector<double> nodal(2 * static_cast<std::size_t>(nodes));
    std::vector<double> modes(loop.modes.size());
    grid.synthesize(cutoff, 2, loop.modes.data(), nodal.data());
    grid.analyze(cutoff, 2, nodal.data(), modes.data());
    EXPECT_LT(test::distance(modes, loop.modes), 1e-14 * nodes);
  }
}

TEST(FourierGrid, InterpolatesNodalValues) {
  const FourierGrid& grid = FourierGrid::of_size(20);
  const std::vector<double> nodal = random_values(20, 23);
  // Without the mode of half the nodes, the interpolant through values that have none of it.
  std::vector<double> values = nodal;
  double alternating = 0.0;
  for (std::size_t j = 0; j < 20; ++j) alternating += (j % 2 == 0 ? 1.0 : -1.0) * nodal[j] / 20.0;
  for (std::size_t j = 0; j < 20; ++j) values[j] -= (j % 2 == 0 ? 1.0 : -1.0) * alternating;
  std::vector<double> modes(19);
  std::vector<double> again(20);
  grid.analyze(9, 1, values.data(), modes.data());
  grid.synthesize(9, 1, modes.data(), again.data());
  EXPECT_LT(test::distance(again, values), 1e-14);
}

TEST(FourierGrid, AnalysisTruncatesAtTheCutoff) {
  const Loop loop = random_loop(2, 9, 24, 1.0, 0.95);
  const FourierGrid& grid = FourierGrid::of_size(24);
  std::vector<double> nodal(48);
  std::vector<double> modes(2 * 9);
  grid.synthesize(9, 2, loop.modes.data(), nodal.data());
  grid.analyze(4, 2, nodal.data(), modes.data());
  EXPECT_LT(test::distance(modes, with_cutoff(loop, 4).modes), 1e-14);
}

TEST(FourierGrid, SumsAreThoseOfTheirDefinition) {
  for (const int nodes : {2, 3, 6, 14, 15, 45, 60}) {
    const auto n = static_cast<std::size_t>(nodes);
    const std::vector<double> g = random_values(n, 25);
    const int highest = nodes / 2;
    std::vector<double> cosines(n / 2 + 1);
    std::vector<double> sines(n / 2 + 1);
    FourierGrid::of_size(nodes).sums(g.data(), highest, cosines.data(), sines.data());
    for (std::size_t m = 0; m <= n / 2; ++m) {
      double c = 0.0;
      double s = 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        const double phase = two_pi * static_cast<double>((m * j) % n) / nodes;
        c += g[j] * std::cos(phase);
        s += g[j] * std::sin(phase);
      }
      EXPECT_NEAR(cosines[m], c, 1e-13) << nodes << " nodes, m = " << m;
      EXPECT_NEAR(sines[m], s, 1e-13) << nodes << " nodes, m = " << m;
    }
  }
}

TEST(FourierGrid, LeavesNoTraceOfEarlierCalls) {
  const FourierGrid& grid = FourierGrid::of_size(30);
  const Loop loop = random_loop(2, 7, 26);
  const Loop shorter = random_loop(2, 3, 27);
  std::vector<double> before(60);
  std::vector<double> after(60);
  grid.synthesize(3, 2, shorter.modes.data(), before.data());
  std::vector<double> other(60);
  grid.synthesize_derivative(7, 2, loop.modes.data(), other.data());
  grid.synthesize(3, 2, shorter.modes.data(), after.data());
  EXPECT_EQ(before, after);
}

TEST(FourierGridMisuse, IsRefused) {
  for (const int nodes : {-2, 0, 1})
    EXPECT_THROW(static_cast<void>(FourierGrid::of_size(nodes)), core::MisuseError) << nodes;
  EXPECT_THROW(static_cast<void>(FourierGrid::nodes_for(0)), core::MisuseError);
  const FourierGrid& grid = FourierGrid::of_size(10);
  std::vector<double> room(100, 0.0);
  std::vector<double> more(100, 0.0);
  EXPECT_NO_THROW(grid.synthesize(4, 1, room.data(), more.data()));
  EXPECT_THROW(grid.synthesize(5, 1, room.data(), more.data()), core::MisuseError);
  EXPECT_THROW(grid.synthesize_derivative(5, 1, room.data(), more.data()), core::MisuseError);
  EXPECT_THROW(grid.analyze(5, 1, room.data(), more.data()), core::MisuseError);
  std::vector<double> sines(100, 0.0);
  EXPECT_NO_THROW(grid.sums(room.data(), 5, more.data(), sines.data()));
  EXPECT_THROW(grid.sums(room.data(), 6, more.data(), sines.data()), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loop::fourier_test
