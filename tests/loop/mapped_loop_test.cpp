// A loop under a time map against the same orbit under the identity, and against its definition: z at t = T phi(s).
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::mapped_loop_test {
namespace {

using test::two_pi;

Loop even_loop() {
  Loop loop = test::random_loop(4, 12, 31, 3.3, 0.5);
  loop.winding = {1.0, 0.0, -2.0, 0.0};
  return loop;
}

std::vector<TimeMap> maps() {
  return {{1.7, {}}, {0.6, {}}, {3.0, {}}, {1.0, {0.3, -0.2, 0.0, 0.1}}, {1.4, {0.05, 0.1, -0.1, 0.0, 0.02, 0.03}}};
}

constexpr int enough = 250;  // harmonics for the loop above under each map

TEST(MappedLoop, IsEvaluatedAtItsTimes) {
  for (const TimeMap& map : maps()) {
    Loop loop = test::random_loop(3, 7, 32);
    loop.winding = {0.0, 1.0, 0.0};
    loop.time_map = map;
    for (const double s : {0.0, 0.4, 1.5, 3.3, 6.0, -1.0, 20.0}) {
      const double time = loop.period * map.phase(s) / two_pi;
      EXPECT_LT(test::distance(state_at(loop, time), test::direct_sum(loop, s).state), 2e-13) << map.kappa << " " << s;
    }
  }
}

TEST(MappedLoop, ReExpandedIsTheSameOrbit) {
  const Loop even = even_loop();
  for (const TimeMap& map : maps()) {
    const Loop mapped = with_time_map(even, map, enough);
    EXPECT_EQ(mapped.time_map, map);
    EXPECT_EQ(mapped.cutoff, enough);
    EXPECT_LT(tail(mapped), 1e-14) << "the test needs more harmonics";
    EXPECT_EQ(state_at(mapped, 0.0).size(), 4u);
    for (const double t : {0.0, 0.1, 0.8, 1.7, 3.2, -5.0, 40.0})
      EXPECT_LT(test::distance(state_at(mapped, t), state_at(even, t)), 5e-13) << map.kappa << " at " << t;
    const Loop back = with_time_map(mapped, {}, even.cutoff);
    EXPECT_LT(test::distance(back.modes, even.modes), 1e-13) << map.kappa;
  }
}

TEST(MappedLoop, SameMapIsOnlyTruncatedOrPadded) {
  const Loop mapped = with_time_map(even_loop(), maps().front(), 40);
  EXPECT_EQ(with_time_map(mapped, mapped.time_map, 20).modes, with_cutoff(mapped, 20).modes);
}

TEST(MappedLoop, MeasuresAreThoseOfTheOrbit) {
  const Loop even = even_loop();
  Loop other = test::random_loop(4, 10, 33, 3.3, 0.5);
  other.winding = even.winding;
  for (const TimeMap& map : maps()) {
    const Loop mapped = with_time_map(even, map, enough);
    const Loop other_mapped = with_time_map(other, map, enough);
    EXPECT_NEAR(rms_speed(mapped), rms_speed(even), 1e-12);
    EXPECT_NEAR(rms_amplitude(mapped), rms_amplitude(even), 1e-12);
    EXPECT_NEAR(rms_size(mapped), rms_size(even), 1e-12);
    EXPECT_LT(test::distance(mean_state(mapped), mean_state(even)), 1e-13);
    EXPECT_NEAR(mean_distance(mapped, other_mapped), mean_distance(even, other), 1e-12);
    EXPECT_NEAR(mean_distance(mapped, other), mean_distance(even, other), 1e-12);
    EXPECT_NEAR(mean_distance(other, mapped), mean_distance(even, other), 1e-12);
    EXPECT_LT(mean_distance(mapped, even), 1e-13);
    const Loop twice = with_time_map(even, {2.0, {0.1, 0.1}}, enough);
    EXPECT_LT(mean_distance(mapped, twice), 1e-13);
    EXPECT_NEAR(mean_distance(other_mapped, twice), mean_distance(even, other), 1e-12);
  }
}

// sqrt of the mean over time of the square of g(s), by its definition on many nodes.
double rms_over_time(const TimeMap& map, const std::function<double(double)>& square) {
  constexpr int nodes = 8000;
  double sum = 0.0;
  for (int j = 0; j < nodes; ++j) sum += map.density(two_pi * j / nodes) * square(two_pi * j / nodes);
  return std::sqrt(sum / nodes);
}

// The pulse has many more harmonics than the loop.
TEST(MappedLoop, SharpPulseIsResolved) {
  Loop loop = test::random_loop(3, 4, 37);
  Loop other = test::random_loop(3, 4, 38);
  loop.time_map = other.time_map = {12.0, {}};
  const auto gap = [&](double s) {
    return std::pow(test::distance(test::direct_sum(loop, s).state, test::direct_sum(other, s).state), 2);
  };
  EXPECT_NEAR(mean_distance(loop, other), rms_over_time(loop.time_map, gap), 1e-13);
}

TEST(MappedLoop, DistanceOfLoopsUnderVeryDifferentMaps) {
  const Loop even = test::random_loop(3, 3, 39);
  Loop sharp = test::random_loop(3, 3, 40);
  sharp.time_map = {1.0, {0.9, 0.0}};
  const auto gap = [&](double s) {
    return std::pow(
        test::distance(test::direct_sum(sharp, s).state, test::direct_sum(even, sharp.time_map.phase(s)).state), 2);
  };
  const double expected = rms_over_time(sharp.time_map, gap);
  EXPECT_NEAR(mean_distance(even, sharp), expected, 1e-13);
  EXPECT_NEAR(mean_distance(sharp, even), expected, 1e-13);
}

TEST(MappedLoop, SamplesGiveMeansOverTime) {
  const Loop even = even_loop();
  const auto mean_cosine = [](const Loop& loop) {
    const Samples samples = samples_of(loop);
    double sum = 0.0;
    for (std::size_t j = 0; j < samples.weights.size(); ++j) sum += samples.weights[j] * std::cos(samples.states[j]);
    return sum;
  };
  const double expected = mean_cosine(with_cutoff(even, 60));
  ASSERT_GT(std::abs(expected), 1e-3);
  for (const TimeMap& map : maps())
    EXPECT_NEAR(mean_cosine(with_time_map(even, map, enough)), expected, 1e-13) << map.kappa;
}

TEST(MappedLoop, ShiftedInTimeIsTheSameOrbitStartedLater) {
  for (const TimeMap& map : maps())
    for (const double fraction : {0.5, 0.25, 1.0 / 3.0, -0.2, 1.7}) {
      Loop loop = test::random_loop(3, 7, 34);
      loop.winding = {0.0, 1.0, 0.0};
      loop.time_map = map;
      const Loop shifted = time_shifted(loop, fraction);
      for (const double t : {0.0, 0.3, 2.0, 4.1})
        EXPECT_LT(test::distance(state_at(shifted, t), state_at(loop, t + fraction * loop.period)), 1e-12)
            << map.kappa << ", fraction " << fraction;
      if (map.coefficients.empty() && fraction == 0.5) {
        EXPECT_EQ(shifted.time_map, map);
      }
    }
}

TEST(MappedLoop, ShiftOfTheParameterMovesTheCurve) {
  Loop loop = test::random_loop(3, 7, 35);
  loop.time_map = {2.0, {0.1, -0.1}};
  const Loop shifted = parameter_shifted(loop, 0.3);
  for (const double s : {0.0, 1.0, 4.0})
    EXPECT_LT(test::distance(test::direct_sum(shifted, s).state, test::direct_sum(loop, s + 0.3 * two_pi).state),
              1e-13);
}

TEST(MappedLoop, SymmetriesAreSeenUnderAMap) {
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  const std::vector<Isotropy> groups{{test::element_of(pendulum, "S", 1, 2), test::element_of(pendulum, "R")},
                                     {test::element_of(pendulum, "R", 1, 4)},
                                     {test::element_of(pendulum, "RS", 1, 2)},
                                     {}};
  for (const Isotropy& group : groups) {
    const Loop even =
        test::random_loop_in(Subspace(4, 8, group), constant_loop(std::vector<double>(4, 0.0), 3.0, 8), 36, 0.5);
    for (const TimeMap& map : maps()) {
      const Loop mapped = with_time_map(even, map, 120);
      EXPECT_EQ(to_text(find_isotropy(pendulum, mapped, 1e-10)), to_text(find_isotropy(pendulum, even, 1e-10)));
      for (const SymmetryElement& g : group) EXPECT_LT(symmetry_defect(mapped, g, pendulum.angles), 1e-12);
      const SymmetryElement later = test::element_of(pendulum, "S", 1, 3);
      EXPECT_NEAR(symmetry_defect(mapped, later, pendulum.angles), symmetry_defect(even, later, pendulum.angles),
                  1e-12);
      const auto found = find_map(pendulum, mapped, transformed(even, later), 1e-10);
      ASSERT_TRUE(found.has_value());
    }
  }
}

TEST(MappedLoopMisuse, BadMapsAreRefused) {
  Loop loop = test::random_loop(2, 3, 1);
  for (const TimeMap& bad : {TimeMap{0.0, {}}, TimeMap{-2.0, {}}, TimeMap{1.0, {0.1}}, TimeMap{1.0, {NAN, 0.0}}}) {
    loop.time_map = bad;
    EXPECT_THROW(validate(loop), core::MisuseError);
  }
}

}  // namespace
}  // namespace orbweaver::loop::mapped_loop_test
