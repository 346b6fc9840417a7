// Zeros of test functions that a multiplier's turns count, and those that neither signs nor counts show alone.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"

namespace detector_counts_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::bifurcation;

systems::Structure of_two_pairs() {
  systems::Structure structure;
  structure.dimension = 6;
  structure.conserved = {"energy"};
  structure.symplectic = true;
  return structure;
}

/// A family along which one multiplier turns, `turns(position)` times, with the functions of the sectors up to q = 8.
struct TurningFamily {
  std::function<double(double)> turns;
  bool counted = true;
  std::vector<TestFunction> functions = test_functions(structure(), 2, 4);
  std::vector<Bracket> brackets{};
  std::vector<MissedZeros> missed{};

  static systems::Structure structure() {
    systems::Structure out;
    out.dimension = 4;
    out.conserved = {"energy"};
    out.symplectic = true;
    return out;
  }
  [[nodiscard]] TestPoint point(double position) const {
    spectrum::Stability stability;
    stability.turns = turns(position);
    stability.fundamental = {2.0 * std::cos(2.0 * std::numbers::pi * stability.turns)};
    stability.fundamental_error = {1e-12};
    TestPoint out{position, {}};
    for (const TestFunction& function : functions) {
      out.readings.push_back(evaluate(function, structure(), stability));
      if (counted) out.passed.push_back(zeros_passed(function, structure(), stability));
    }
    if (counted) out.turns = stability.turns;
    return out;
  }
  void run(const std::vector<double>& positions, bool has_orbits_between = true) {
    Detector detector;
    const auto probe = [&](double position) {
      return has_orbits_between ? std::optional(point(position)) : std::nullopt;
    };
    for (const double position : positions)
      for (const Bracket& bracket : detector.advance(point(position), probe)) brackets.push_back(bracket);
    for (const Bracket& bracket : detector.finish(probe)) brackets.push_back(bracket);
    missed = detector.missed();
  }
  /// Places of a function's zeros between two positions, for turns that only grow.
  [[nodiscard]] int zeros(std::size_t f, double from, double to) const {
    const double place = static_cast<double>(functions[f].sector.j) / functions[f].sector.q;
    const auto below = [&](double position) {
      const double n = std::floor(turns(position) - place);
      return functions[f].sector.q > 2 ? n + std::floor(turns(position) + place) : n;
    };
    return static_cast<int>(below(to) - below(from));
  }
  [[nodiscard]] int found(std::size_t f) const {
    return static_cast<int>(
        std::count_if(brackets.begin(), brackets.end(), [&](const Bracket& b) { return b.function == f && !b.lost; }));
  }
};

std::vector<double> steps_of(double length, double to) {
  std::vector<double> positions;
  for (double position = 0.03; position < to; position += length) positions.push_back(position);
  return positions;
}

// In steps of up to a quarter of a turn, as branches take them: all zeros, once each, however long the steps are.
TEST(DetectorCounts, CountedZerosAreFoundWhateverTheSteps) {
  for (const double length : {0.02, 0.07, 0.11, 0.149, 0.199, 0.249}) {
    TurningFamily family{[](double x) { return x + 0.02 * std::sin(3.0 * x); }};
    const std::vector<double> positions = steps_of(length, 6.0);
    family.run(positions);
    for (std::size_t f = 0; f < family.functions.size(); ++f)
      EXPECT_EQ(family.found(f), family.zeros(f, positions.front(), positions.back()))
          << "q = " << family.functions[f].sector.q << ", j = " << family.functions[f].sector.j << ", step " << length;
    EXPECT_TRUE(family.missed.empty()) << length;
  }
}

// Steps of almost a turn look like small ones backwards.
TEST(DetectorCounts, CountsTellWhatSignsDoNot) {
  TurningFamily family{[](double x) { return x; }};
  TurningFamily uncounted = family;
  uncounted.counted = false;
  const std::vector<double> positions = steps_of(0.97, 20.0);
  family.run(positions);
  uncounted.run(positions);
  int unseen = 0;
  for (std::size_t f = 0; f < family.functions.size(); ++f) {
    const int zeros = family.zeros(f, positions.front(), positions.back());
    EXPECT_EQ(family.found(f), zeros) << f;
    EXPECT_LE(uncounted.found(f), zeros) << f;
    unseen += zeros - uncounted.found(f);
  }
  EXPECT_GT(unseen, 0) << "if signs and minima show them, this is no test of counts";
  for (const Bracket& bracket : family.brackets)
    EXPECT_EQ(bracket.passed, family.functions[bracket.function].sector.q <= 2);
}

// In one step two real multipliers pass mu_1 mu_2 = 1, which is nothing, and a complex pair the unit circle: the
// product has one sign at both ends, and only its dip between tells.
TEST(DetectorCounts, ATorusPointBesideANeutralSaddleIsBracketed) {
  systems::Structure structure;
  structure.dimension = 5;
  structure.driven = structure.dissipative = true;
  constexpr double torus = 0.44;
  for (const double steep : {10.0, 40.0, 400.0})
    for (double saddle = 0.3013; saddle < 0.6; saddle += 0.0142) {
      SCOPED_TRACE(fmt::format("{} {}", steep, saddle));
      const auto point = [&](double x) {
        spectrum::Stability stability;
        const std::complex<double> pair = std::polar(std::exp(0.5 * (x - torus)), 1.9);
        stability.fundamental = {2.0 * std::exp(steep * (x - saddle)), pair, std::conj(pair), 0.5};
        stability.fundamental_error.assign(4, 1e-12);
        return TestPoint{x, {evaluate({TestFunction::Kind::torus, {}}, structure, stability)}, {}};
      };
      Detector detector;
      const auto probe = [&](double x) { return std::optional(point(x)); };
      std::vector<Bracket> brackets;
      for (double x = -0.68; x < 1.5; x += 0.2)
        for (const Bracket& bracket : detector.advance(point(x), probe)) brackets.push_back(bracket);
      EXPECT_EQ(brackets.size(), 2U);
      EXPECT_TRUE(std::any_of(brackets.begin(), brackets.end(),
                              [](const Bracket& b) { return !b.tangency && b.from < torus && torus < b.to; }));
    }
}

// Of two pairs each index passes 2 within a family's first step: the product of their functions has one sign at both
// ends, and hardly changes. (Three oscillators with reflections, beside a given orbit: two of three branch points were
// lost.)
TEST(DetectorCounts, IndicesThatPassTheirPlaceWithinOneStepAreFound) {
  const systems::Structure structure = of_two_pairs();
  const std::vector<TestFunction> functions = test_functions(structure, 1, 2);
  const auto point = [&](double x, bool counted) {
    spectrum::Stability stability;
    stability.fundamental = {2.0 + 1e-3 * (x - 2.001), 2.0 + 1e-3 * (x - 2.5)};
    stability.fundamental_error = {1e-12, 1e-12};
    TestPoint out{x, {}};
    for (const TestFunction& function : functions) {
      out.readings.push_back(evaluate(function, structure, stability));
      if (counted) out.passed.push_back(zeros_passed(function, structure, stability));
    }
    return out;
  };
  const auto found = [&](bool counted) {
    Detector detector;
    std::vector<Bracket> brackets;
    for (double x = 2.0; x < 4.5; x += 1.0)
      for (const Bracket& bracket :
           detector.advance(point(x, counted), [&](double at) { return std::optional(point(at, counted)); }))
        if (functions[bracket.function].kind == TestFunction::Kind::sector) brackets.push_back(bracket);
    EXPECT_TRUE(detector.missed().empty());
    return brackets;
  };
  const std::vector<Bracket> brackets = found(true);
  ASSERT_EQ(brackets.size(), 2U);
  EXPECT_TRUE(brackets[0].from < 2.001 && 2.001 < brackets[0].to);
  EXPECT_TRUE(brackets[1].from < 2.5 && 2.5 < brackets[1].to);
  EXPECT_LT(found(false).size(), 2U) << "if signs and minima show them, this is no test of counts";
}

// Two indices that a symmetry makes equal pass 2 and come back within one step: their product has one sign. They are a
// complex pair to rounding, here and there.
TEST(DetectorCounts, DoubleIndicesPassTogether) {
  const systems::Structure structure = of_two_pairs();
  const std::vector<TestFunction> functions = test_functions(structure, 1, 2);
  for (const double shift : {0.0, 0.3, 0.49}) {
    const auto point = [&](double x) {
      const double off = x - 2.5 - shift;
      const double index = 2.0 + 1e-2 * (0.02 - off * off);
      const double split = std::fmod(1e3 * x, 2.0) < 1.0 ? 1e-15 : 0.0;
      spectrum::Stability stability;
      stability.fundamental = {{index, split}, {index, -split}};
      stability.fundamental_error = {1e-13, 1e-13};
      TestPoint out{x, {}};
      for (const TestFunction& function : functions) {
        out.readings.push_back(evaluate(function, structure, stability));
        out.passed.push_back(zeros_passed(function, structure, stability));
      }
      return out;
    };
    Detector detector;
    std::vector<Bracket> brackets;
    for (double x = 0.0; x < 6.5; x += 1.0)
      for (const Bracket& bracket : detector.advance(point(x), [&](double at) { return std::optional(point(at)); }))
        if (functions[bracket.function].kind == TestFunction::Kind::sector) brackets.push_back(bracket);
    EXPECT_TRUE(detector.missed().empty());
    ASSERT_EQ(brackets.size(), 2U) << shift;
    for (const double side : {-1.0, 1.0}) {
      const Bracket& bracket = brackets[side < 0.0 ? 0 : 1];
      const double place = 2.5 + shift + side * std::sqrt(0.02);
      EXPECT_TRUE(bracket.is_double && !bracket.tangency) << place;
      EXPECT_TRUE(bracket.from < place && place < bracket.to) << bracket.from << " " << place << " " << bracket.to;
    }
  }
}

// A pair that leaves the real axis as a quadruplet may come back elsewhere: nothing is counted.
TEST(DetectorCounts, NothingIsCountedOfIndicesThatAreNotRealOrNotTold) {
  const systems::Structure structure = of_two_pairs();
  const TestFunction two{TestFunction::Kind::sector, {1, 0}};
  spectrum::Stability stability;
  stability.fundamental_error = {1e-9, 1e-9};
  stability.fundamental = {2.5, 3.0};
  EXPECT_EQ(zeros_passed(two, structure, stability).number, 2.0);
  stability.fundamental = {1.5, 3.0};
  EXPECT_EQ(zeros_passed(two, structure, stability).number, 1.0);
  stability.fundamental = {2.0 + 1e-10, 3.0};
  EXPECT_FALSE(zeros_passed(two, structure, stability).is_known());
  stability.fundamental = {{2.5, 0.1}, {2.5, -0.1}};
  EXPECT_FALSE(zeros_passed(two, structure, stability).is_known());
}

TEST(DetectorCounts, CountedZerosThatCannotBeBracketedAreTold) {
  for (const double length : {0.2, 1.0, 6.3}) {
    TurningFamily family{[](double x) { return x; }};
    const std::vector<double> positions = steps_of(length, 14.0);
    family.run(positions, false);
    for (std::size_t f = 0; f < family.functions.size(); ++f) {
      int all = family.found(f);
      for (const MissedZeros& missed : family.missed)
        if (missed.function == f) all += missed.count;
      EXPECT_EQ(all, family.zeros(f, positions.front(), positions.back())) << length;
    }
    EXPECT_FALSE(family.missed.empty());
  }
}

}  // namespace
}  // namespace detector_counts_test
