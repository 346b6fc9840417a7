#include "orbweaver/loop/symmetry/alignment.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::alignment_test {
namespace {

using test::element_of;
using test::two_pi;

const double irrational = std::sqrt(2.0) / 7.0;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

Loop sample() { return test::random_loop(4, 14, 61); }

Loop rotation() {
  Loop loop = sample();
  loop.winding = {1.0, -2.0, 0.0, 0.0};
  return loop;
}

// `from` must be brought to `to` exactly, by the symmetry `name`; returns the alignment.
Alignment expect_same(const systems::Structure& system, const Loop& from, const Loop& to, const std::string& name) {
  const Alignment found = align(system, from, to);
  EXPECT_EQ(found.name, name);
  EXPECT_LT(found.distance, 1e-12) << name;
  EXPECT_LT(mean_distance(aligned(from, found), to), 1e-12) << name;
  return found;
}

TEST(TimeSamples, AreStatesAtTheirTimes) {
  Loop loop = rotation();
  for (const TimeMap& map : {TimeMap{}, TimeMap{1.7, {}}, TimeMap{1.4, {0.05, 0.1, -0.1, 0.0}}}) {
    loop.time_map = map;
    const TimeSamples samples = time_samples(loop);
    ASSERT_EQ(samples.count, 240);
    EXPECT_EQ(samples.period, loop.period);
    EXPECT_EQ(samples.winding, loop.winding);
    for (const int j : {0, 1, 60, 119, 239}) {
      const std::vector<double> state = state_at(loop, loop.period * j / 240.0);
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(samples.states[i * 240 + static_cast<std::size_t>(j)],
                    state[i] - loop.winding[i] * two_pi * j / 240.0, 1e-13);
    }
  }
}

TEST(TimeSamples, InterpolantIsTheLoopInTime) {
  EXPECT_LT(mean_distance(interpolant(time_samples(rotation(), 29)), rotation()), 1e-14);
  const Loop mapped = with_time_map(rotation(), {1.3, {}}, 60);
  EXPECT_LT(mean_distance(interpolant(time_samples(mapped)), rotation()), 1e-12);
  EXPECT_LT(mean_distance(resolved_in_time(mapped), rotation()), 1e-12);
  EXPECT_THROW(static_cast<void>(interpolant(time_samples(sample(), 3))), core::MisuseError);
}

// Beyond 119 harmonics in time: the interpolant of 240 samples is not enough.
TEST(TimeSamples, SharpLoopIsResolvedInTime) {
  const Loop even = test::random_loop(4, 150, 62, 4.0, 0.95);
  const Loop mapped = with_time_map(even, {1.1, {}}, 300);
  EXPECT_GT(mean_distance(interpolant(time_samples(mapped)), even), 1e-4);
  EXPECT_LT(mean_distance(resolved_in_time(mapped), even), 1e-8);
}

TEST(Alignment, FindsAnyTimeShift) {
  for (const double shift : {0.0, 0.25, irrational, 0.9999, 1e-7})
    EXPECT_NEAR(expect_same(pendulum(), sample(), time_shifted(sample(), shift), "1").shift, shift, 1e-14) << shift;
}

TEST(Alignment, FindsEverySymmetry) {
  for (const systems::Structure* system : {&pendulum(), &galaxy()}) {
    for (const systems::Symmetry& s : system->equivariances) {
      const Alignment found = expect_same(*system, sample(), transformed(sample(), s.map, false, irrational), s.name);
      EXPECT_NEAR(found.shift, irrational, 1e-14) << s.name;
      EXPECT_FALSE(found.reversing);
    }
    for (const systems::Symmetry& r : system->reversors) {
      const Alignment found = expect_same(*system, sample(), transformed(sample(), r.map, true, irrational), r.name);
      EXPECT_NEAR(found.shift, irrational, 1e-14) << r.name;
      EXPECT_TRUE(found.reversing);
    }
  }
}

// R C is no declared reversor of Henon and Heiles' system, but a symmetry all the same.
TEST(Alignment, FindsReversorsTimesEquivariances) {
  const systems::AffineMap rc = element_of(galaxy(), "R").map * element_of(galaxy(), "C").map;
  expect_same(galaxy(), sample(), transformed(sample(), rc, true, 0.3), "RC");
}

TEST(Alignment, ActsModuloTheLatticeOfAngles) {
  Loop to = transformed(sample(), element_of(pendulum(), "S").map, false, irrational);
  to.cosine(0, 0) += two_pi;
  to.cosine(0, 1) -= 3.0 * two_pi;
  const Alignment found = expect_same(pendulum(), sample(), to, "S");
  EXPECT_EQ(found.turns, (std::vector<double>{1.0, -3.0, 0.0, 0.0}));
  to.cosine(0, 2) += two_pi;
  EXPECT_NEAR(align(pendulum(), sample(), to).distance, two_pi, 2.0) << "a velocity has no lattice";
}

TEST(Alignment, FollowsTheWinding) {
  expect_same(pendulum(), rotation(), time_shifted(rotation(), irrational), "1");
  expect_same(pendulum(), rotation(), time_shifted(rotation(), 0.8), "1");
  for (const char* name : {"R", "RS"})
    expect_same(pendulum(), rotation(), transformed(rotation(), element_of(pendulum(), name).map, true, irrational),
                name);
  expect_same(pendulum(), rotation(), transformed(rotation(), element_of(pendulum(), "S").map, false, 0.7), "S");
  EXPECT_EQ(align(pendulum(), rotation(), sample()).distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(align(pendulum(), sample(), rotation()).distance, std::numeric_limits<double>::infinity());
}

TEST(Alignment, LetsTimeMapsAndCutoffsDiffer) {
  const Loop shifted = time_shifted(rotation(), irrational);
  const Loop mapped = with_time_map(rotation(), {1.3, {}}, 70);
  const Loop other = with_time_map(transformed(shifted, element_of(pendulum(), "RS").map, true, 0.0),
                                   {1.2, {0.1, 0.05, 0.0, 0.1}}, 120);
  expect_same(pendulum(), mapped, shifted, "1");
  expect_same(pendulum(), mapped, other, "RS");
  expect_same(pendulum(), other, mapped, "RS");
  expect_same(pendulum(), with_cutoff(shifted, 31), rotation(), "1");
}

TEST(Alignment, DistanceIsTheSmallestOverShifts) {
  for (const Loop& from : {sample(), rotation()}) {
    Loop to = time_shifted(from, irrational);
    const std::vector<double> noise = test::random_values(to.modes.size(), 63);
    for (std::size_t n = 0; n < noise.size(); ++n) to.modes[n] += 1e-2 * noise[n];
    to.cosine(0, 0) += 0.1;
    const Alignment found = align(pendulum(), from, to);
    EXPECT_EQ(found.name, "1");
    EXPECT_NEAR(mean_distance(aligned(from, found), to), found.distance, 1e-14);
    const auto at = [&](double step) {
      Alignment moved = found;
      moved.shift += step;
      return mean_distance(aligned(from, moved), to);
    };
    for (const double step : {-1e-4, 1e-4, 1e-2, 0.5}) EXPECT_GT(at(step), found.distance) << step;
    // Newton's method ends where the slope is zero: on both sides the distance grows alike.
    EXPECT_NEAR(at(1e-5), at(-1e-5), 1e-3 * (at(1e-5) - found.distance) + 1e-13);
  }
}

// Two pulses that differ little: a shift of half a period comes close, and is not the answer.
TEST(Alignment, TakesTheClosestOfSeveralMinima) {
  Loop loop = test::random_loop(4, 14, 64);
  for (int k = 1; k <= loop.cutoff; k += 2)
    for (int i = 0; i < 4; ++i) loop.cosine(k, i) *= 1e-9, loop.sine(k, i) *= 1e-9;
  for (const double shift : {0.1, 0.6, irrational})
    EXPECT_NEAR(expect_same(pendulum(), loop, time_shifted(loop, shift), "1").shift, shift, 1e-12);
}

TEST(Alignment, OfASymmetricOrbitTakesTheFirstSymmetryAndTheSmallestShift) {
  const Isotropy both{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  const Loop loop = test::random_loop_in(Subspace(4, 8, both), constant_loop(std::vector<double>(4), 5.0, 8), 65);
  EXPECT_NEAR(expect_same(pendulum(), loop, loop, "1").shift, 0.0, 1e-14);
  const Loop mirrored = transformed(loop, element_of(pendulum(), "S").map, false, 0.0);
  EXPECT_NEAR(expect_same(pendulum(), loop, mirrored, "1").shift, 0.5, 1e-14);
  for (const int m : {2, 3, 5})
    for (const double shift : {0.12, 0.43, 0.78, irrational}) {
      const double found = align(pendulum(), repeated(sample(), m), time_shifted(repeated(sample(), m), shift)).shift;
      const double smallest = std::remainder(shift, 1.0 / m);
      EXPECT_NEAR(found, smallest < 0.0 ? 1.0 + smallest : smallest, 1e-13) << m << " " << shift;
    }
}

TEST(Alignment, OfConstantLoopsIsTheirDistance) {
  const Loop a = constant_loop(std::vector<double>{0.1, 0.2, 0.0, 0.0}, 3.0, 4);
  const Loop b = constant_loop(std::vector<double>{0.1 + two_pi, 0.5, 0.0, 0.0}, 3.0, 4);
  EXPECT_NEAR(align(pendulum(), a, b).distance, 0.3, 1e-14);
}

// On 240 samples the two are 1e-4 apart, with all their harmonics less than 1e-8.
TEST(Alignment, HopelessLoopsAreToldByTheirCoarseDistance) {
  const Loop even = test::random_loop(4, 150, 62, 4.0, 0.95);
  const Loop mapped = with_time_map(even, {1.1, {}}, 300);
  EXPECT_LT(align(pendulum(), mapped, even, 0.5).distance, 1e-8);
  EXPECT_LT(align(pendulum(), mapped, even).distance, 1e-8);
  EXPECT_GT(align(pendulum(), mapped, even, 1e-5).distance, 1e-4);
}

TEST(Alignment, RefusesOtherDimensions) {
  EXPECT_THROW(static_cast<void>(align(pendulum(), sample(), test::random_loop(2, 5, 1))), core::MisuseError);
}

TEST(Repetitions, AreCounted) {
  EXPECT_EQ(repetitions(sample(), 1e-9), 1);
  for (const int m : {2, 3, 5, 6, 7, 12}) {
    const Loop loop = time_shifted(repeated(sample(), m), irrational);
    EXPECT_EQ(repetitions(loop, 1e-9), m);
    const Loop primitive = without_repetition(loop, m);
    EXPECT_NEAR(primitive.period, sample().period, 1e-14);
    expect_same(pendulum(), primitive, sample(), "1");
  }
}

TEST(Repetitions, LeaveTheWindingWhole) {
  Loop loop = repeated(rotation(), 3);
  EXPECT_EQ(repetitions(loop, 1e-9), 3);
  EXPECT_EQ(without_repetition(loop, 3).winding, rotation().winding);
  loop.winding = {2.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(repetitions(loop, 1e-9), 1) << "a third of it would wind by two thirds";
  EXPECT_THROW(static_cast<void>(without_repetition(loop, 3)), core::MisuseError);
}

TEST(Repetitions, HoldToTheTolerance) {
  Loop loop = repeated(sample(), 2);
  loop.cosine(3, 1) += 1e-3 * std::sqrt(2.0);
  EXPECT_EQ(repetitions(loop, 1.01e-3), 2);
  EXPECT_EQ(repetitions(loop, 0.99e-3), 1);
}

TEST(Repetitions, AreSeenUnderATimeMap) {
  Loop once = test::random_loop(4, 6, 67, 4.2, 0.5);
  once.winding = {1.0, -2.0, 0.0, 0.0};
  for (const int m : {2, 3, 5, 7, 9, 11}) {
    const Loop loop = with_time_map(repeated(once, m), {1.0, {0.2, -0.1}}, 40 * m);
    EXPECT_EQ(repetitions(loop, 1e-9), m);
    expect_same(pendulum(), without_repetition(loop, m), once, "1");
  }
  EXPECT_EQ(repetitions(with_time_map(once, {1.0, {0.2, -0.1}}, 60), 1e-9), 1);
}

// Features of 1/10 of the period: the 119 harmonics in time that a first look takes leave the shift wrong.
TEST(AlignmentInTime, SeesWhatPassesFastUnderItsTimeMap) {
  Loop from = test::random_loop(2, 14, 61);
  from.time_map = TimeMap{10.0, {}};
  for (const double shift : {0.0, 1e-4, 3e-3}) {
    const Loop to = time_shifted(from, shift);
    const Alignment found = align_in_time(test::structure_of("van_der_pol"), from, to);
    EXPECT_NEAR(found.shift, shift, 1e-11);
    EXPECT_LT(found.distance, 1e-6 * mean_distance(from, Loop(time_shifted(from, 0.3))));
  }
}

}  // namespace
}  // namespace orbweaver::loop::alignment_test
