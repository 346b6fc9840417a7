#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/bifurcation/fold_watch.hpp"
#include "orbweaver/core/error.hpp"

namespace fold_watch_test {
namespace {

using namespace orbweaver;
using bifurcation::Fold;
using bifurcation::FoldWatch;

template <class Period, class Energy>
std::vector<Fold> folds_of(const Period& period, const Energy& energy, double step, double to) {
  FoldWatch watch;
  std::vector<Fold> all;
  for (int n = 0; n * step <= to; ++n)
    for (const Fold& fold : watch.advance(n * step, period(n * step), energy(n * step))) all.push_back(fold);
  return all;
}

TEST(FoldWatch, FindsEveryExtremumOfEachQuantity) {
  const double pi = std::numbers::pi;
  for (const double step : {0.9, 0.31, 0.01}) {
    const auto folds =
        folds_of([](double x) { return 7 + std::cos(x); }, [](double x) { return -2 + std::sin(x); }, step, 7.3);
    const std::vector<std::pair<Fold::Quantity, double>> expected{{Fold::Quantity::energy, 0.5 * pi},
                                                                  {Fold::Quantity::period, pi},
                                                                  {Fold::Quantity::energy, 1.5 * pi},
                                                                  {Fold::Quantity::period, 2 * pi}};
    ASSERT_EQ(folds.size(), expected.size()) << "step " << step;
    for (std::size_t n = 0; n < folds.size(); ++n) {
      EXPECT_EQ(folds[n].quantity, expected[n].first);
      EXPECT_LT(folds[n].from, expected[n].second);
      EXPECT_GT(folds[n].to, expected[n].second);
      EXPECT_NEAR(folds[n].to - folds[n].from, 2 * step, 1e-12);
    }
  }
}

TEST(FoldWatch, RoundingMakesNoFold) {
  const auto noisy = [](double x) { return 7.0 + 1e-11 * std::sin(1e5 * x); };
  EXPECT_TRUE(folds_of(noisy, noisy, 0.01, 20.0).empty());
  EXPECT_TRUE(folds_of([&](double x) { return noisy(x) + 1e-9 * x; }, noisy, 0.01, 20.0).empty());
}

TEST(FoldWatch, SlowTurnIsFoundOnceAndAroundTheTurn) {
  // Steps so small that neighbours near the turn do not differ.
  const auto turning = [](double x) { return 7.0 - 1e-4 * (x - 0.5) * (x - 0.5); };
  const auto folds = folds_of(
      turning, [](double) { return 1.0; }, 1e-4, 1.0);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_LT(folds[0].from, 0.5);
  EXPECT_GT(folds[0].to, 0.5);
  EXPECT_LT(folds[0].to - folds[0].from, 0.02);
}

TEST(FoldWatch, PassesOverWhatIsNotThere) {
  const auto folds = folds_of([](double x) { return (x > 0.25 && x < 2) || x > 2.5 ? std::cos(x) : std::nan(""); },
                              [](double) { return std::nan(""); }, 0.1, 5.0);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].quantity, Fold::Quantity::period);
}

TEST(FoldWatch, SlopeAtTheLastOrbitTellsAFoldBeforeIt) {
  const auto period = [](double x) { return 7.0 - (x - 0.55) * (x - 0.55); };
  FoldWatch watch;
  for (const double x : {0.0, 0.2, 0.4, 0.6}) EXPECT_TRUE(watch.advance(x, period(x), x).empty()) << x;
  const auto folds = watch.finish(0.6, {.period = -2.0 * 0.05, .energy = 1.0});
  ASSERT_EQ(folds.size(), 1u);  // T turns within, E does not
  EXPECT_EQ(folds[0].quantity, Fold::Quantity::period);
  EXPECT_DOUBLE_EQ(folds[0].from, 0.4);
  EXPECT_DOUBLE_EQ(folds[0].to, 0.6);
  EXPECT_TRUE(watch.finish(0.6, {.period = 0.1}).empty()) << "a slope like the last difference";
  EXPECT_TRUE(watch.finish(0.6, {.period = -1e-10}).empty()) << "rounding";
}

TEST(FoldWatch, FoldThatDifferencesShowIsNotFoundAgainAtTheEnd) {
  const auto period = [](double x) { return 7.0 - (x - 0.45) * (x - 0.45); };
  FoldWatch watch;
  std::size_t found = 0;
  for (const double x : {0.0, 0.2, 0.4, 0.7}) found += watch.advance(x, period(x), x).size();
  EXPECT_EQ(found, 1u);
  EXPECT_TRUE(watch.finish(0.7, {.period = -0.5, .energy = 1.0}).empty());
  EXPECT_TRUE(FoldWatch().finish(0.0, {.period = 1.0}).empty()) << "no orbit";
}

TEST(FoldWatch, RefusesPositionsThatDoNotIncrease) {
  FoldWatch watch;
  (void)watch.advance(1.0, 2.0, 3.0);
  EXPECT_THROW((void)watch.advance(1.0, 2.1, 3.0), core::MisuseError);
}

}  // namespace
}  // namespace fold_watch_test
