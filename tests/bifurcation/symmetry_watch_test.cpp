// Pitchforks made by hand: base + epsilon v, with a base that has one symmetry more than v.
#include "orbweaver/bifurcation/symmetry_watch.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bifurcation/symmetry_gain.hpp"
#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::bifurcation::symmetry_watch_test {
namespace {

using test::element_of;

const double irrational = std::sqrt(2.0) / 7.0;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

loop::Loop plus(const loop::Loop& base, double epsilon, const loop::Loop& v) {
  loop::Loop out = base;
  for (std::size_t n = 0; n < out.modes.size(); ++n) out.modes[n] += epsilon * v.modes[n];
  return out;
}

// A loop of the subspace, signs as in loop::Subspace.
loop::Loop in_subspace(const loop::Isotropy& isotropy, const std::vector<int>& signs, std::uint64_t seed) {
  const std::vector<double> origin(4, 0.0);
  return test::random_loop_in(loop::Subspace(4, 24, isotropy, signs), loop::constant_loop(origin, 5.0, 24), seed, 0.9);
}

struct Pitchfork {
  systems::Structure system;
  loop::Isotropy own;
  loop::Loop base;
  loop::Loop v;
  [[nodiscard]] loop::Loop at(double epsilon) const { return plus(base, epsilon, v); }
};

// S@1/2 R@0 loses S@1/2.
Pitchfork loss_of_s() {
  const loop::Isotropy both{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  return {pendulum(), {both[1]}, in_subspace(both, {1, 1}, 81), in_subspace(both, {-1, 1}, 82)};
}

// Three times around a shorter orbit.
Pitchfork threefold() {
  const loop::Isotropy own{element_of(pendulum(), "R")};
  const loop::Loop once =
      test::random_loop_in(loop::Subspace(4, 8, own), loop::constant_loop(std::vector<double>(4, 0.0), 5.0, 8), 83);
  loop::Loop base = with_cutoff(loop::repeated(once, 3), 24);
  loop::Loop v = in_subspace(own, {1}, 84);
  for (int k = 0; k <= 24; k += 3)
    for (int i = 0; i < 4; ++i) v.cosine(k, i) = v.sine(k, i) = 0.0;
  return {pendulum(), own, base, v};
}

// A subharmonic of order 4 that loses S: the base has S@1/4 and v turns by a quarter under it.
Pitchfork fourfold() {
  const loop::Isotropy own{element_of(pendulum(), "R")};
  const loop::Loop base = in_subspace({element_of(pendulum(), "S", 1, 4), own[0]}, {1, 1}, 85);
  loop::Loop v = in_subspace(own, {1}, 86);
  for (int k = 0; k <= 24; k += 2)
    for (int i = 0; i < 4; ++i) v.cosine(k, i) = v.sine(k, i) = 0.0;
  return {pendulum(), own, base, v};
}

void expect_arrival(const Pitchfork& p, const std::string& text) {
  const SymmetryWatch watch(p.system, p.own);
  const loop::Loop a = p.at(0.2);
  const loop::Loop b = p.at(-0.1);
  const auto gain = test::first_passed(watch, a, b);
  ASSERT_TRUE(gain.has_value()) << text;
  EXPECT_EQ(test::to_text(*gain), text);
  EXPECT_NEAR(watch.signed_part(*gain, a, a), 1.0, 1e-12);
  EXPECT_NEAR(watch.signed_part(*gain, a, b), -0.5, 1e-12);
  EXPECT_NEAR(watch.relative_size(*gain, a, b), 0.5, 1e-12);
  EXPECT_NEAR(watch.relative_size(*gain, a, p.base), 0.0, 1e-13);
}

TEST(SymmetryWatch, SeesTheSymmetryThatAPitchforkBroke) { expect_arrival(loss_of_s(), "S@1/2"); }
TEST(SymmetryWatch, SeesASubharmonicArrive) { expect_arrival(threefold(), "1@1/3"); }
TEST(SymmetryWatch, TakesWhatGeneratesMost) {
  expect_arrival(fourfold(), "S@1/4");
  const Pitchfork p = fourfold();
  const std::vector<SymmetryGain> all =
      SymmetryWatch(p.system, p.own).all_passed(SymmetryWatch::sampled(p.at(0.2)), SymmetryWatch::sampled(p.at(-0.1)));
  std::vector<std::string> texts;
  for (const SymmetryGain& gain : all) texts.push_back(test::to_text(gain));
  EXPECT_EQ(texts, (std::vector<std::string>{"S@1/4", "S@3/4", "1@1/2"}));
}

TEST(SymmetryWatch, SeesRotationsOfThePlane) {
  const loop::Isotropy c{element_of(galaxy(), "C", 1, 3)};
  Pitchfork p{galaxy(), {}, in_subspace(c, {1}, 87), in_subspace({}, {}, 88)};
  // What keeps C@1/3 in v is taken out: the mean of v over the group.
  loop::Loop kept = p.v;
  for (const int n : {1, 2}) {
    const loop::Loop image = loop::transformed(p.v, element_of(galaxy(), n == 1 ? "C" : "CC", n, 3));
    for (std::size_t m = 0; m < kept.modes.size(); ++m) kept.modes[m] += image.modes[m];
  }
  p.v = plus(p.v, -1.0 / 3.0, kept);
  expect_arrival(p, "C@1/3");
}

TEST(SymmetryWatch, PassesNothingOnOneSide) {
  for (const Pitchfork& p : {loss_of_s(), threefold(), fourfold()}) {
    const SymmetryWatch watch(p.system, p.own);
    EXPECT_FALSE(test::first_passed(watch, p.at(0.2), p.at(0.1)).has_value());
    EXPECT_FALSE(test::first_passed(watch, p.at(1e-6), p.at(1e-4)).has_value())
        << "the first orbits of a branch born here";
    EXPECT_FALSE(test::first_passed(watch, p.at(-1e-4), p.at(-1e-6)).has_value());
    EXPECT_FALSE(test::first_passed(watch, p.base, p.at(0.1)).has_value())
        << "a broken part of rounding size has no sign";
  }
}

TEST(SymmetryWatch, SeesAnOrbitThatLiesOnTheCrossing) {
  const Pitchfork p = loss_of_s();
  const SymmetryWatch watch(p.system, p.own);
  ASSERT_TRUE(test::first_passed(watch, p.at(0.2), p.base).has_value());
  EXPECT_EQ(test::to_text(*test::first_passed(watch, p.at(0.2), p.base)), "S@1/2");
}

// The corrector leaves of the part what the crossing lets it, on either side.
TEST(SymmetryWatch, SeesAnOrbitThatHasSlippedOntoTheOtherFamily) {
  for (const Pitchfork& p : {loss_of_s(), threefold()})
    for (const double left : {1e-9, -1e-9}) {
      const SymmetryWatch watch(p.system, p.own);
      EXPECT_TRUE(test::first_passed(watch, p.at(0.2), p.at(left)).has_value()) << left;
      EXPECT_FALSE(test::first_passed(watch, p.at(0.2), p.at(1e-4)).has_value());
    }
}

// The broken part turns over without becoming small: the size at the root tells.
TEST(SymmetryWatch, TellsATurnFromAnArrival) {
  const Pitchfork p = loss_of_s();
  const loop::Isotropy both{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  const loop::Loop other = in_subspace(both, {-1, 1}, 89);
  const SymmetryWatch watch(p.system, p.own);
  const auto turned = [&](double angle) {
    return plus(plus(p.base, 0.2 * std::cos(angle), p.v), 0.2 * std::sin(angle), other);
  };
  const auto gain = test::first_passed(watch, turned(0.0), turned(3.0));
  ASSERT_TRUE(gain.has_value());
  double low = 0.0, high = 3.0;
  for (int n = 0; n < 50; ++n) {
    const double middle = 0.5 * (low + high);
    (watch.signed_part(*gain, turned(0.0), turned(middle)) > 0.0 ? low : high) = middle;
  }
  EXPECT_NEAR(watch.signed_part(*gain, turned(0.0), turned(low)), 0.0, 1e-10);
  EXPECT_GT(watch.relative_size(*gain, turned(0.0), turned(low)), 0.5);
}

// Reversors at any phase, where the branch has none.
TEST(SymmetryWatch, SeesReversorsAtAnyPhase) {
  for (const char* name : {"R", "RS"}) {
    const loop::Isotropy r{element_of(pendulum(), name)};
    const Pitchfork p{pendulum(),
                      {},
                      loop::time_shifted(in_subspace(r, {1}, 90), irrational),
                      loop::time_shifted(in_subspace(r, {-1}, 91), irrational)};
    const SymmetryWatch watch(p.system, p.own);
    const loop::Loop a = p.at(0.05);
    const auto gain = test::first_passed(watch, a, p.at(-0.03));
    ASSERT_TRUE(gain.has_value()) << name;
    EXPECT_EQ(test::to_text(*gain), name);
    EXPECT_TRUE(gain->reversing);
    EXPECT_NEAR(gain->phase, 1.0 - 2.0 * irrational, 0.05);
    EXPECT_LT(watch.signed_part(*gain, a, p.at(-0.03)), -0.3);
    EXPECT_LT(watch.relative_size(*gain, a, p.base), 1e-12);
    EXPECT_FALSE(test::first_passed(watch, a, p.at(0.03)).has_value());
    const SymmetryWatch with_reversor(p.system, r);
    for (const SymmetryGain& other :
         with_reversor.all_passed(SymmetryWatch::sampled(a), SymmetryWatch::sampled(p.at(-0.03))))
      EXPECT_FALSE(other.reversing);
  }
}

// Whole turns of angles make no difference, and a mean that passes pi is no arrival.
TEST(SymmetryWatch, ActsModuloTheLatticeOfAngles) {
  Pitchfork p = loss_of_s();
  p.base.cosine(0, 1) += std::numbers::pi;
  expect_arrival(p, "S@1/2");
  loop::Loop a = p.at(0.2);
  loop::Loop b = a;
  a.cosine(0, 1) = 0.5 * std::numbers::pi - 0.01;
  b.cosine(0, 1) = 0.5 * std::numbers::pi + 0.01;
  EXPECT_FALSE(test::first_passed(SymmetryWatch(p.system, p.own), a, b).has_value());
}

TEST(SymmetryWatch, SeesRotationsArrive) {
  Pitchfork p = threefold();
  p.own = {};
  p.base = loop::repeated(test::random_loop(4, 8, 92), 3);
  p.base = with_cutoff(p.base, 24);
  p.base.winding = {3.0, 0.0, 0.0, 0.0};
  p.v.winding = p.base.winding;
  expect_arrival(p, "1@1/3");
  p.base.winding = {1.0, 0.0, 0.0, 0.0};
  p.base.cosine(0, 0) = 0.5 * std::numbers::pi;  // so that the mean has S@1/2
  EXPECT_FALSE(test::first_passed(SymmetryWatch(p.system, p.own), p.at(0.2), p.at(-0.1)).has_value());
}

// S turns a rotation the other way round: no orbit that winds has it.
TEST(SymmetryWatch, LeavesOutWhatTurnsRotationsRound) {
  Pitchfork p = loss_of_s();
  p.base.winding = {1.0, 0.0, 0.0, 0.0};
  p.base.cosine(0, 0) = 0.5 * std::numbers::pi;  // so that the mean has S@1/2
  EXPECT_FALSE(test::first_passed(SymmetryWatch(p.system, p.own), p.at(0.2), p.at(-0.1)).has_value());
}

TEST(SymmetryWatch, SaysWhatIsNearlyGained) {
  const Pitchfork p = threefold();
  const SymmetryWatch watch(p.system, p.own);
  const auto nearly = [&](double from, double to) {
    std::vector<std::string> texts;
    for (const SymmetryGain& gain :
         watch.nearly_gained(SymmetryWatch::sampled(p.at(from)), SymmetryWatch::sampled(p.at(to))))
      texts.push_back(test::to_text(gain));
    return texts;
  };
  EXPECT_EQ(nearly(0.02, 0.01), std::vector<std::string>{"1@1/3"});
  EXPECT_TRUE(nearly(0.01, 0.02).empty()) << "on the way out";
  EXPECT_TRUE(nearly(2.0, 1.0).empty()) << "far away";
}

// A slow oscillation, and a small fast one that changes its sign: a shift by a hundredth of the period changes the slow
// one less than the fast one, and still nothing repeats.
TEST(SymmetryWatch, AFastOscillationThatChangesItsSignIsNoRepetition) {
  const auto at = [](double fast) {
    loop::Loop out = loop::constant_loop(std::vector<double>(4, 0.0), 5.0, 24);
    for (int i = 0; i < 4; ++i) {
      out.cosine(1, i) = 1.0 + 0.1 * i;
      out.sine(13, i) = fast;
    }
    return out;
  };
  const SymmetryWatch watch(pendulum(), {});
  const auto passed = watch.all_passed(SymmetryWatch::sampled(at(0.2)), SymmetryWatch::sampled(at(-0.2)));
  EXPECT_TRUE(std::none_of(passed.begin(), passed.end(), [](const SymmetryGain& gain) { return gain.name == "1"; }));
}

TEST(SymmetryWatch, RespectsTheLargestOrder) {
  const Pitchfork p = threefold();
  EXPECT_FALSE(test::first_passed(SymmetryWatch(p.system, p.own, 2, 2), p.at(0.2), p.at(-0.1)).has_value());
  EXPECT_TRUE(test::first_passed(SymmetryWatch(p.system, p.own, 3), p.at(0.2), p.at(-0.1)).has_value());
  EXPECT_THROW(SymmetryWatch(p.system, p.own, 0), core::MisuseError);
}

TEST(SymmetryWatch, SeesThroughATimeMap) {
  const Pitchfork p = loss_of_s();
  const SymmetryWatch watch(p.system, p.own);
  const loop::TimeMap map{1.5, {}};
  const auto gain = test::first_passed(watch, with_time_map(p.at(0.2), map, 140), p.at(-0.1));
  ASSERT_TRUE(gain.has_value());
  EXPECT_NEAR(watch.signed_part(*gain, p.at(0.2), with_time_map(p.at(-0.1), map, 140)), -0.5, 1e-9);
}

}  // namespace
}  // namespace orbweaver::bifurcation::symmetry_watch_test
