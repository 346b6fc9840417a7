#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/core/error.hpp"
#include "support/stated_system.hpp"

namespace test_functions_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::bifurcation;
using Kind = TestFunction::Kind;
using Complex = std::complex<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

spectrum::Stability stability_of(std::vector<Complex> values, double error) {
  spectrum::Stability stability;
  stability.fundamental_error.assign(values.size(), error);
  stability.fundamental = std::move(values);
  return stability;
}

std::vector<Sector> sectors_of(const std::vector<TestFunction>& functions) {
  std::vector<Sector> found;
  for (const TestFunction& function : functions)
    if (function.kind == Kind::sector) found.push_back(function.sector);
  return found;
}

TEST(Sectors, AreThoseWhoseOrbitsCloseInTime) {
  using List = std::vector<Sector>;
  EXPECT_EQ(sectors(1, 4), (List{{1, 0}, {2, 1}, {3, 1}, {4, 1}}));
  EXPECT_EQ(sectors(2, 4), (List{{1, 0}, {2, 1}, {3, 1}, {4, 1}, {6, 1}, {8, 1}, {8, 3}}));
  EXPECT_EQ(sectors(2, 1), (List{{1, 0}, {2, 1}}));
  EXPECT_EQ(sectors(3, 1), (List{{1, 0}, {3, 1}}));
  EXPECT_EQ(sectors(1, 5), (List{{1, 0}, {2, 1}, {3, 1}, {4, 1}, {5, 1}, {5, 2}}));
  EXPECT_THROW((void)sectors(0, 4), core::MisuseError);
  EXPECT_THROW((void)sectors(2, 0), core::MisuseError);
}

TEST(Sectors, MultiplicityIsThatOfTheWholeMap) {
  EXPECT_EQ((Sector{1, 0}).multiplicity(2), 1);
  EXPECT_EQ((Sector{2, 1}).multiplicity(2), 1);
  EXPECT_EQ((Sector{3, 1}).multiplicity(2), 3);
  EXPECT_EQ((Sector{4, 1}).multiplicity(2), 2);
  EXPECT_EQ((Sector{8, 3}).multiplicity(2), 4);
  EXPECT_EQ((Sector{4, 1}).multiplicity(1), 4);
}

TEST(Sectors, IndexIsTwiceTheCosine) {
  for (int q = 1; q <= 12; ++q)
    for (int j = 0; 2 * j <= q; ++j) {
      if (std::gcd(j, q) != 1) continue;
      EXPECT_NEAR((Sector{q, j}).index(), 2.0 * std::cos(2.0 * std::numbers::pi * j / q), 1e-15) << q;
    }
}

TEST(TestFunctions, ListedAreThoseWithSomethingToSay) {
  EXPECT_TRUE(test_functions(test::structure_of(2, true, true), 2, 4).empty());
  EXPECT_TRUE(test_functions(test::structure_of(1, false, false), 1, 4).empty());
  EXPECT_TRUE(test_functions(test::structure_of(2, true, false), 1, 4).empty());
  const auto pendulum = test_functions(test::structure_of(4, true, true), 2, 4);
  EXPECT_EQ(pendulum.size(), 7u);
  EXPECT_EQ(sectors_of(pendulum), sectors(2, 4));
  const auto three = test_functions(test::structure_of(6, true, true), 1, 4);
  EXPECT_EQ(three.size(), 5u);
  EXPECT_EQ(three.back().kind, Kind::krein);
  const auto dissipative = test_functions(test::structure_of(3, false, false), 1, 4);
  EXPECT_EQ(sectors_of(dissipative), (std::vector<Sector>{{1, 0}, {2, 1}}));
  ASSERT_EQ(dissipative.size(), 3u);
  EXPECT_EQ(dissipative.back().kind, Kind::torus);
  EXPECT_EQ(test_functions(test::structure_of(2, false, false), 1, 1).size(), 1u);
  EXPECT_EQ(test_functions(test::structure_of(3, true, false), 1, 4).size(), 2u);
}

TEST(TestFunctions, SignTellsTheSideOfTheSector) {
  const auto one = test::structure_of(4, true, true);
  const TestFunction quarter{Kind::sector, {4, 1}};
  EXPECT_DOUBLE_EQ(evaluate(quarter, one, stability_of({0.5}, 0.0)).value, 0.2);
  EXPECT_EQ(evaluate(quarter, one, stability_of({0.5}, 0.1)).sign(), 1);
  EXPECT_EQ(evaluate(quarter, one, stability_of({-0.5}, 0.1)).sign(), -1);
  EXPECT_EQ(evaluate(quarter, one, stability_of({1e17}, 1e5)).sign(), 1);
  const auto two = test::structure_of(6, true, true);
  EXPECT_EQ(evaluate(quarter, two, stability_of({-5.0, -0.5}, 0.1)).sign(), 1);
  EXPECT_EQ(evaluate(quarter, two, stability_of({-5.0, 0.5}, 0.1)).sign(), -1);
  EXPECT_EQ(evaluate(quarter, two, stability_of({Complex(-1, 0.2), Complex(-1, -0.2)}, 1e-9)).sign(), 1);
}

TEST(TestFunctions, NoSignBelowTheErrorOrWithoutAValue) {
  const auto one = test::structure_of(4, true, true);
  const TestFunction quarter{Kind::sector, {4, 1}};
  EXPECT_EQ(evaluate(quarter, one, stability_of({0.05}, 0.051)).sign(), 0);
  EXPECT_EQ(evaluate(quarter, one, stability_of({nan}, 0.1)).sign(), 0);
  EXPECT_EQ(evaluate(quarter, one, stability_of({0.5}, nan)).sign(), 0);
  EXPECT_EQ(evaluate(quarter, one, stability_of({0.5}, INFINITY)).sign(), 0);
  EXPECT_EQ(evaluate(quarter, one, stability_of({0.0}, 0.0)).sign(), 0);
}

/// Changes every index by its error bound, in both directions, and compares.
void expect_bounded(const TestFunction& function, const systems::Structure& system, const std::vector<Complex>& values,
                    double error, double tightness) {
  const Reading reading = evaluate(function, system, stability_of(values, error));
  double largest = 0.0;
  for (unsigned pattern = 0; pattern < 1u << values.size(); ++pattern) {
    std::vector<Complex> changed = values;
    for (std::size_t i = 0; i < values.size(); ++i) changed[i] += (pattern >> i & 1u) != 0 ? error : -error;
    largest = std::max(largest, std::abs(evaluate(function, system, stability_of(changed, 0.0)).value - reading.value));
  }
  EXPECT_LE(largest, reading.error) << "kind " << static_cast<int>(function.kind) << " q " << function.sector.q;
  EXPECT_LE(reading.error, tightness * largest)
      << "kind " << static_cast<int>(function.kind) << " q " << function.sector.q << " error " << error;
}

TEST(TestFunctions, ErrorCoversWhatTheIndicesHaveWrong) {
  const auto one = test::structure_of(4, true, true);
  const auto two = test::structure_of(6, true, true);
  const auto three = test::structure_of(8, true, true);
  const auto dissipative = test::structure_of(4, false, false);
  for (const double error : {1e-6, 1e-3, 0.1}) {
    expect_bounded({Kind::sector, {4, 1}}, one, {-0.3}, error, 2.4);  // slope 2/2.3^2, bound 2/2.3
    for (const Sector& sector : sectors(2, 4)) {
      expect_bounded({Kind::sector, sector}, two, {0.7, -1.3}, error, 4.0);
      expect_bounded({Kind::sector, sector}, three, {-3.0, 0.7, 1.9}, error, 10.0);
    }
    expect_bounded({Kind::krein, {}}, two, {0.7, -1.3}, error, 4.0);
    expect_bounded({Kind::krein, {}}, three, {4.0, 0.7, -1.3}, error, 10.0);
    expect_bounded({Kind::sector, {1, 0}}, dissipative, {1.4, 0.6, -0.2}, error, 10.0);
    expect_bounded({Kind::sector, {2, 1}}, dissipative, {1.4, 0.6, -0.2}, error, 10.0);
    expect_bounded({Kind::torus, {}}, dissipative, {1.4, 0.6, -0.2}, error, 10.0);
  }
}

TEST(TestFunctions, ValuesStayWithinOne) {
  const auto two = test::structure_of(6, true, true);
  for (const Complex a : {Complex(0.0), Complex(2.0), Complex(-1e9), Complex(0.1, 2.0), Complex(-3.0, 50.0)})
    for (const Complex b : {std::conj(a), Complex(1e12), Complex(-2.0)}) {
      if (a.imag() != 0.0 && b != std::conj(a)) continue;
      for (const TestFunction& function : test_functions(two, 2, 4))
        EXPECT_LE(std::abs(evaluate(function, two, stability_of({a, b}, 0.0)).value), 1.0) << a << b;
    }
}

// As in a chain of ten pendulums: the detector judges values by absolute errors.
TEST(TestFunctions, ManyFactorsLeaveAValueOfTheirOwnSize) {
  const auto ten = test::structure_of(20, true, true);
  std::vector<Complex> indices;
  for (int n = 0; n < 9; ++n) indices.emplace_back(1.9 - 0.4 * n);
  for (const TestFunction& function : test_functions(ten, 1, 2)) {
    const double value = std::abs(evaluate(function, ten, stability_of(indices, 1e-12)).value);
    EXPECT_GT(value, 0.02) << name_of(function.kind) << function.sector.q;
  }
  indices[4] = 2.0 + 1e-6;  // near a zero it is as steep as its factor, or steeper
  const double beside = evaluate({Kind::sector, {1, 0}}, ten, stability_of(indices, 1e-12)).value;
  EXPECT_GT(std::abs(beside), 1e-6 / 4.0);
  EXPECT_LT(std::abs(beside), 9.0 * 1e-6 / 4.0);
}

TEST(TestFunctions, KreinChangesSignWhereTwoIndicesBecomeComplex) {
  const auto three = test::structure_of(8, true, true);
  const TestFunction krein{Kind::krein, {}};
  for (const double other : {0.4, 1e4}) {
    EXPECT_EQ(evaluate(krein, three, stability_of({0.61, 0.60, other}, 1e-9)).sign(), 1);
    EXPECT_EQ(evaluate(krein, three, stability_of({Complex(0.6, 0.01), Complex(0.6, -0.01), other}, 1e-9)).sign(), -1);
  }
  for (const double huge : {1e149, 1e200, 1e300}) {  // whose squares are beyond double precision
    const Reading reading = evaluate(krein, test::structure_of(6, true, true), stability_of({0.6, huge}, 1e-9));
    EXPECT_NEAR(reading.value, 0.5, 1e-15) << huge;
    EXPECT_EQ(reading.sign(), 1);
  }
  EXPECT_EQ(is_event(krein, three, stability_of({0.6, 0.6, 3.0}, 1e-9), false), true);
  EXPECT_EQ(is_event(krein, three, stability_of({0.6, 0.6, 3.0}, 1e-9), true), false);
  EXPECT_EQ(is_event(krein, three, stability_of({0.6, 3.0, 3.0}, 1e-9), false), false);
}

TEST(TestFunctions, TorusIsForComplexPairs) {
  const auto three = test::structure_of(4, false, false);
  const TestFunction torus{Kind::torus, {}};
  const auto pair = [](double modulus) {
    return stability_of({std::polar(modulus, 1.2), std::polar(modulus, -1.2), 0.3}, 1e-9);
  };
  EXPECT_EQ(evaluate(torus, three, pair(0.99)).sign(), -evaluate(torus, three, pair(1.01)).sign());
  EXPECT_EQ(is_event(torus, three, pair(1.0), false), true);
  EXPECT_EQ(is_event(torus, three, stability_of({4.0, 0.25, 0.3}, 1e-9), false), false);
  // A neutral saddle so near to 1 that the sum of its two multipliers is 2 to rounding.
  EXPECT_EQ(is_event(torus, three, stability_of({std::exp(1e-9), std::exp(-1e-9), 0.3}, 1e-14), false), std::nullopt);
  EXPECT_EQ(is_event(torus, three, stability_of({std::exp(1e-3), std::exp(-1e-3), 0.3}, 1e-9), false), false);
}

TEST(TestFunctions, TorusKeepsItsValueBesideLargeMultipliers) {
  const TestFunction torus{Kind::torus, {}};
  const auto two = test::structure_of(3, false, false);
  const auto value = [&](Complex a, Complex b, double error) {
    return evaluate(torus, two, stability_of({a, b}, error));
  };
  for (const double size : {1e140, 1e160, 1e300}) {
    const Reading pair = value(std::polar(size, 1.2), std::polar(size, -1.2), 1e-9 * size);
    EXPECT_NEAR(pair.value, 1.0, 1e-14) << size;
    EXPECT_GT(pair.error, 3.9e-9) << size;
    EXPECT_LT(pair.error, 4.1e-9) << size;
    EXPECT_EQ(value(size, -size, 1e-9).value, -1.0) << size;
    EXPECT_EQ(value(std::polar(size, 1.2), std::polar(size, -1.2), 2.0 * size).sign(), 0) << size;
  }
  // On both sides of where the numbers become relative ones.
  const double below = value(1e74, 1e75, 1e66).error;
  const double beyond = value(1e76, 1e77, 1e68).error;
  EXPECT_NEAR(below, 2.2e-8, 1e-13);
  EXPECT_NEAR(beyond, below, 1e-13);
}

TEST(TestFunctions, MultiplierOfTheEnergyIsLeftOut) {
  const auto system = test::structure_of(4, true, false);
  for (const TestFunction& function : test_functions(system, 1, 4)) {
    const Reading reading = evaluate(function, system, stability_of({1.5, 0.5, 1.0}, 1e-9));
    EXPECT_NE(reading.sign(), 0);
    EXPECT_EQ(reading.value,
              evaluate(function, test::structure_of(3, false, false), stability_of({1.5, 0.5}, 1e-9)).value);
  }
}

TEST(TestFunctions, MisuseIsRefused) {
  const auto one = test::structure_of(4, true, true);
  const auto dissipative = test::structure_of(3, false, false);
  EXPECT_THROW((void)evaluate({Kind::sector, {1, 0}}, one, stability_of({0.5, 0.6}, 0.1)), core::MisuseError);
  EXPECT_THROW((void)evaluate({Kind::torus, {}}, one, stability_of({0.5}, 0.1)), core::MisuseError);
  EXPECT_THROW((void)evaluate({Kind::krein, {}}, dissipative, stability_of({0.5, 0.6}, 0.1)), core::MisuseError);
  EXPECT_THROW((void)evaluate({Kind::sector, {3, 1}}, dissipative, stability_of({0.5, 0.6}, 0.1)), core::MisuseError);
}

TEST(Decided, IsAnIndexWhoseErrorIsSmallWhereItMayPassSomething) {
  EXPECT_TRUE(are_decided(stability_of({{1.2, 0.0}}, 1e-5)));
  EXPECT_FALSE(are_decided(stability_of({{1.2, 0.0}}, 1e-3)));
  EXPECT_FALSE(are_decided(stability_of({{-2.5, 0.0}}, 1e-3)));
  EXPECT_TRUE(are_decided(stability_of({{1e8, 0.0}}, 1e-3)));
  EXPECT_FALSE(are_decided(stability_of({{1e8, 0.0}, {0.1, 0.0}}, 1e-3)));
}

TEST(Isolated, IsAnOrbitWhoseIndicesDifferFromTwoByMoreThanTheirErrors) {
  EXPECT_TRUE(is_isolated(stability_of({{2.1, 0.0}}, 1e-3)));
  EXPECT_FALSE(is_isolated(stability_of({{2.005, 0.0}}, 1e-3)));  // the bound is good to a factor of ten
  EXPECT_FALSE(is_isolated(stability_of({{1.0, 0.0}}, 18.0)));
  EXPECT_FALSE(is_isolated(stability_of({{-1.0, 0.0}, {2.0, 0.0}}, 1e-9)));
  EXPECT_TRUE(is_isolated(stability_of({{-2.0, 0.0}}, 1e-9)));
}

}  // namespace
}  // namespace test_functions_test
