// Multipliers outside the unit circle, and what passes it between two orbits.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/outside_circle.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "support/stated_system.hpp"

namespace outside_circle_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::bifurcation;
using Complex = std::complex<double>;
using Kind = TestFunction::Kind;

spectrum::Stability stability_of(std::vector<Complex> values, double error) {
  spectrum::Stability stability;
  stability.fundamental_error.assign(values.size(), error);
  stability.fundamental = std::move(values);
  return stability;
}

std::optional<OutsideCircle> counted(std::vector<Complex> values, double error) {
  const auto dimension = static_cast<int>(values.size()) + 1;
  return outside_circle(test::structure_of(dimension, false, false), stability_of(std::move(values), error));
}

TEST(OutsideCircle, CountsRealMultipliersOnBothSidesAndPairs) {
  EXPECT_EQ(counted({-2665.0, -0.405}, 1e-9), (OutsideCircle{0, 1, 0}));
  EXPECT_EQ(counted({1170.0, 2.163}, 1e-9), (OutsideCircle{2, 0, 0}));
  EXPECT_EQ(counted({{3.0, 4.0}, {3.0, -4.0}, -1.5, {0.1, 0.2}, {0.1, -0.2}}, 1e-9), (OutsideCircle{0, 1, 1}));
  EXPECT_EQ(counted({{3.0, 1e-12}, {3.0, -1e-12}}, 1e-9), (OutsideCircle{2, 0, 0})) << "a pair to rounding only";
}

TEST(OutsideCircle, TellsNothingThatErrorBoundsLeaveOpen) {
  EXPECT_TRUE(counted({1.0 + 1e-6, 0.2}, 1e-7));
  EXPECT_FALSE(counted({1.0 + 1e-6, 0.2}, 1e-5));
  EXPECT_FALSE(counted({5.0, std::polar(1.0 - 1e-6, 2.0), std::polar(1.0 - 1e-6, -2.0)}, 1e-5));
  EXPECT_FALSE(counted({std::nan(""), 0.2}, 1e-9));
  EXPECT_FALSE(outside_circle(test::structure_of(4, true, true), stability_of({2.5}, 1e-9)));
  // The last one is the energy's own.
  EXPECT_EQ(outside_circle(test::structure_of(4, true, false), stability_of({2.5, 0.1, 1.0}, 1e-9)),
            (OutsideCircle{1, 0, 0}));
}

TEST(OutsideCircle, ATurnOutsideIsNoPassage) {
  EXPECT_EQ(least_passages({0, 1, 0}, {2, 0, 0}), (CirclePassages{0, 1, 0})) << "Lur'e, alpha = -0.5485 to -0.6156";
  EXPECT_EQ(least_passages({0, 2, 0}, {2, 0, 0}), CirclePassages{});
  EXPECT_EQ(least_passages({0, 2, 0}, {0, 0, 1}), CirclePassages{});
  EXPECT_EQ(least_passages({0, 0, 0}, {2, 0, 0}), (CirclePassages{2, 0, 0})) << "two stay on the axis";
  EXPECT_EQ(least_passages({0, 0, 0}, {0, 0, 1}), (CirclePassages{0, 0, 1}));
  EXPECT_EQ(least_passages({1, 0, 0}, {0, 1, 0}), (CirclePassages{1, 1, 0}));
  EXPECT_EQ(least_passages({0, 0, 1}, {1, 0, 0}), (CirclePassages{1, 0, 0}));
}

// Whatever happens on the way, no fewer passages are told than there are nets of, and each parity is right.
TEST(OutsideCircle, LeastPassagesAreAtMostThoseOfAnyWay) {
  std::mt19937 generator(51);
  for (int way = 0; way < 2000; ++way) {
    OutsideCircle from{3, 3, 3};
    OutsideCircle to = from;
    CirclePassages net;
    int passed = 0;
    for (int n = 0; n < 6; ++n) {
      const int sign = generator() % 2 == 0 ? 1 : -1;
      switch (generator() % 5) {
        case 0: to.beyond_one += sign, net.at_one += sign, ++passed; break;
        case 1: to.beyond_minus_one += sign, net.at_minus_one += sign, ++passed; break;
        case 2: to.pairs += sign, net.as_pairs += sign, passed += 2; break;
        case 3: to.beyond_one += 2 * sign, to.pairs -= sign; break;
        default: to.beyond_minus_one += 2 * sign, to.pairs -= sign;
      }
    }
    const CirclePassages least = least_passages(from, to);
    EXPECT_EQ((least.at_one - net.at_one) % 2, 0);
    EXPECT_EQ((least.at_minus_one - net.at_minus_one) % 2, 0);
    EXPECT_LE(least.at_one + least.at_minus_one + 2 * least.as_pairs, passed);
    EXPECT_GE(least.at_one + least.at_minus_one + 2 * least.as_pairs,
              std::abs(net.at_one + net.at_minus_one + 2 * net.as_pairs));
    EXPECT_EQ(least_passages(to, from), least);
  }
}

/// A family of a system in three dimensions along which the trace of the fundamental map changes evenly from 0 to 1,
/// and not before and behind, and its determinant not at all, as where stretching is strong.
struct Stretched {
  systems::Structure structure = test::structure_of(3, false, false);
  std::vector<TestFunction> functions = test_functions(structure, 1, 2);
  double from;
  double to;
  double determinant;
  std::vector<Bracket> brackets{};
  std::vector<MissedZeros> missed{};

  [[nodiscard]] TestPoint point(double x) const {
    const double half = 0.5 * (from + std::clamp(x, 0.0, 1.0) * (to - from));
    const Complex root = std::sqrt(Complex(half * half - determinant));
    const Complex larger = half < 0.0 ? half - root : half + root;
    const std::vector<Complex> values{larger, determinant / larger};
    const spectrum::Stability stability = stability_of(values, 1e-9);
    TestPoint out{x, {}};
    for (const TestFunction& function : functions) {
      out.readings.push_back(evaluate(function, structure, stability));
      out.passed.push_back(zeros_passed(function, structure, stability));
    }
    return out;
  }
  void run(double step) {
    Detector detector;
    const auto probe = [&](double x) { return std::optional(point(x)); };
    for (double x = -step; x < 1.0 + 1.5 * step; x += step)
      for (const Bracket& bracket : detector.advance(point(x), probe)) brackets.push_back(bracket);
    for (const Bracket& bracket : detector.finish(probe)) brackets.push_back(bracket);
    missed = detector.missed();
  }
};

// One passes -1, meets the other, they turn, and come back beyond 1: two events were looked for that are none.
TEST(OutsideCircle, OnlyTheDoublingIsBracketedOfMultipliersThatTurn) {
  for (const double size : {1e3, 1e5, 1e7})
    for (const double step : {0.07, 0.19, 0.43, 1.0}) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", step " << step);
      Stretched family{.from = -2.0 * size, .to = 0.8 * size, .determinant = size};
      family.run(step);
      EXPECT_TRUE(family.missed.empty());
      ASSERT_EQ(family.brackets.size(), 1U);
      const Bracket& found = family.brackets.front();
      EXPECT_EQ(family.functions[found.function], (TestFunction{Kind::sector, {2, 1}}));
      EXPECT_FALSE(found.tangency || found.is_double);
      const double doubling = (2.0 * size - 1.0 - size) / (2.8 * size);
      EXPECT_TRUE(found.from < doubling && doubling < found.to) << doubling;
    }
}

// Beyond 1 at both ends, and a fold and a doubling between: both passages stay.
TEST(OutsideCircle, PassagesBesideATurnAreBracketed) {
  for (const double size : {1e3, 1e7})
    for (const double step : {0.19, 1.0}) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", step " << step);
      Stretched family{.from = -2.0 * size, .to = 3.0 * size, .determinant = size};
      family.run(step);
      EXPECT_TRUE(family.missed.empty());
      ASSERT_EQ(family.brackets.size(), 2U);
      EXPECT_EQ(family.functions[family.brackets[0].function].sector.q, 2);
      EXPECT_EQ(family.functions[family.brackets[1].function].sector.q, 1);
    }
}

// Two real multipliers that a symmetry makes equal pass 1 together: the function only touches zero.
TEST(OutsideCircle, TwoEqualMultipliersThatPassOneAreBracketed) {
  const systems::Structure structure = test::structure_of(3, false, false);
  const TestFunction one{Kind::sector, {1, 0}};
  const auto point = [&](double x) {
    const double split = std::fmod(1e3 * std::abs(x), 2.0) < 1.0 ? 1e-13 : 0.0;
    const double multiplier = 0.7 + 0.13 * x;
    const spectrum::Stability stability = stability_of({{multiplier, split}, {multiplier, -split}}, 1e-12);
    return TestPoint{x, {evaluate(one, structure, stability)}, {zeros_passed(one, structure, stability)}};
  };
  Detector detector;
  std::vector<Bracket> brackets;
  for (double x = 0.0; x < 4.5; x += 1.0)
    for (const Bracket& bracket : detector.advance(point(x), [&](double at) { return std::optional(point(at)); }))
      brackets.push_back(bracket);
  constexpr double place = 0.3 / 0.13;
  EXPECT_TRUE(detector.missed().empty());
  ASSERT_EQ(brackets.size(), 1U);
  EXPECT_TRUE(brackets[0].is_double);
  EXPECT_TRUE(brackets[0].from < place && place < brackets[0].to);
}

// A complex pair passes the circle beside a neutral saddle, and no orbit between the two can be had: it is told.
TEST(OutsideCircle, ATorusPointThatCannotBeBracketedIsTold) {
  const systems::Structure structure = test::structure_of(5, false, false);
  const TestFunction torus{Kind::torus, {}};
  const auto point = [&](double x, double saddle, double modulus) {
    const Complex pair = std::polar(modulus, 1.9);
    const spectrum::Stability stability = stability_of({saddle, pair, std::conj(pair), 0.5}, 1e-12);
    return TestPoint{x, {evaluate(torus, structure, stability)}, {zeros_passed(torus, structure, stability)}};
  };
  const auto nothing = [](double) { return std::optional<TestPoint>(); };
  Detector detector;
  EXPECT_TRUE(detector.advance(point(0.0, 1.5, 0.9), nothing).empty());
  EXPECT_TRUE(detector.advance(point(1.0, 2.5, 1.1), nothing).empty());
  ASSERT_EQ(detector.missed().size(), 1U);
  EXPECT_EQ(detector.missed()[0].count, 1);
}

}  // namespace
}  // namespace outside_circle_test
