#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "orbweaver/numerics/random.hpp"

namespace detector_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::bifurcation;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Functions = std::vector<std::function<Reading(double)>>;

/// A family whose readings are given functions of the position; counts its probes.
struct Family {
  Functions functions;
  Detector detector{};
  int probes = 0;
  double last = -std::numeric_limits<double>::infinity();
  double earlier = last;
  double before_that = last;

  [[nodiscard]] TestPoint point(double position) const {
    TestPoint out{position, {}};
    for (const auto& function : functions) out.readings.push_back(function(position));
    return out;
  }
  [[nodiscard]] Detector::Probe probe() {
    return [this](double position) -> std::optional<TestPoint> {
      ++probes;
      EXPECT_GT(position, before_that) << "looks back farther than two points before the last one";
      EXPECT_LT(position, last);
      return point(position);
    };
  }
  std::vector<Bracket> advance(double position) {
    before_that = earlier;
    earlier = last;
    last = position;
    std::vector<Bracket> found = detector.advance(point(position), probe());
    EXPECT_TRUE(
        std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.from < b.from; }));
    return found;
  }
  std::vector<Bracket> run(const std::vector<double>& positions) {
    std::vector<Bracket> all;
    for (const double position : positions)
      for (const Bracket& bracket : advance(position)) all.push_back(bracket);
    for (const Bracket& bracket : detector.finish(probe())) all.push_back(bracket);
    return all;
  }
};

std::vector<double> evenly(double from, double to, int intervals) {
  std::vector<double> positions;
  for (int n = 0; n <= intervals; ++n) positions.push_back(from + (to - from) * n / intervals);
  return positions;
}

std::function<Reading(double)> exact(std::function<double(double)> value, double error = 1e-12) {
  return [value = std::move(value), error](double x) { return Reading{value(x), error}; };
}

/// One bracket a true event, around it, in order; brackets of one function share at most an end.
struct Event {
  std::size_t function;
  double position;
  bool tangency = false;
};
void expect_events(std::vector<Bracket> found, const std::vector<Event>& events) {
  std::stable_sort(found.begin(), found.end(), [](const Bracket& a, const Bracket& b) {
    return a.function != b.function ? a.function < b.function : a.from < b.from;
  });
  ASSERT_EQ(found.size(), events.size());
  for (std::size_t n = 0; n < events.size(); ++n) {
    SCOPED_TRACE(testing::Message() << "event " << n << ": [" << found[n].from << ", " << found[n].to << "]");
    EXPECT_EQ(found[n].function, events[n].function);
    EXPECT_LE(found[n].from, events[n].position);
    EXPECT_GE(found[n].to, events[n].position);
    EXPECT_EQ(found[n].tangency, events[n].tangency);
    if (n > 0 && found[n - 1].function == found[n].function) {
      EXPECT_LE(found[n - 1].to, found[n].from);
    }
  }
}

// (2 - s1)(2 - s2) of the vertical family of a trap, small altogether: s2 passes 2 and comes back before both meet.
TEST(Detector, TwoZerosBehindASteepDescentAreSeenByWhereItLeads) {
  Family family{{exact([](double x) { return 530.0 * (0.6586 - x) * (x - 0.66) * (x - 0.682); })}};
  expect_events(family.run({0.6, 0.62, 0.6368, 0.6469, 0.678, 0.69}), {{0, 0.6586}, {0, 0.66}, {0, 0.682}});
}

// As at a crossing where a branch ends.
TEST(Detector, AFunctionThatComesToRestAtZeroCostsNoProbes) {
  Family family{{exact([](double x) { return 1e-3 * x * x; })}};
  for (const double x : {-5.0, -4.0, -3.0, -2.0, -1.0}) EXPECT_TRUE(family.advance(x).empty());
  EXPECT_EQ(family.probes, 0);
}

TEST(Detector, SignChangeIsBracketedByItsStationsAtNoCost) {
  Family family{{exact([](double x) { return 0.4 - 0.1 * x; })}};
  std::vector<Bracket> found;
  for (const double x : {0.0, 0.5, 1.5, 3.0}) EXPECT_TRUE(family.advance(x).empty());
  found = family.advance(4.5);
  expect_events(found, {{0, 4.0}});
  EXPECT_EQ(found[0].from, 3.0);
  EXPECT_EQ(found[0].to, 4.5);
  EXPECT_TRUE(family.advance(6.0).empty());
  EXPECT_TRUE(family.detector.finish(family.probe()).empty());
  EXPECT_EQ(family.probes, 0);
}

TEST(Detector, FunctionsAreJudgedOneByOne) {
  Family family{{exact([](double x) { return 0.05 * (x - 4.2); }), exact([](double x) { return 0.04 * (4.4 - x); }),
                 exact([](double x) { return 0.03 * (x - 12.0); })}};
  expect_events(family.run(evenly(0, 10, 10)), {{0, 4.2}, {1, 4.4}});
}

TEST(Detector, StationsWithoutASignArePassedOver) {
  const auto value = [](double x) { return 0.02 * (x - 4.2); };
  for (const Reading& gap : {Reading{nan, 0.0}, Reading{0.1, nan}, Reading{-0.03, 0.5}, Reading{0.0, 0.1}}) {
    Family family{{[&](double x) { return x > 3.5 && x < 6.5 ? gap : Reading{value(x), 1e-12}; }}};
    const auto found = family.run(evenly(0, 10, 10));
    expect_events(found, {{0, 4.2}});
    EXPECT_EQ(found[0].from, 3.0);
    EXPECT_EQ(found[0].to, 7.0);
  }
}

TEST(Detector, StationsWithoutASignBetweenEqualSignsAreNoEvent) {
  for (const Reading& gap : {Reading{nan, 0.0}, Reading{0.2, nan}, Reading{-0.03, 0.5}}) {
    Family family{{[&](double x) { return x > 3.5 && x < 6.5 ? gap : Reading{0.2 + 0.01 * x, 1e-12}; }}};
    EXPECT_TRUE(family.run(evenly(0, 10, 10)).empty());
  }
}

TEST(Detector, FamilyBornWhereAFunctionVanishesHasNoEventThere) {
  Family family{{exact([](double x) { return 0.01 * x * x; }, 1e-9), exact([](double x) { return -0.002 * x; }, 1e-9),
                 exact([](double x) { return std::abs(x) < 1e-3 ? -1e-10 : 0.01 * x * x; }, 1e-9)}};
  EXPECT_TRUE(family.run({0.0, 1e-5, 1e-4, 1e-2, 0.5, 1.0, 2.0, 3.5, 5.0}).empty());
}

TEST(Detector, NoiseBelowItsBoundIsNoEvent) {
  numerics::Random random(7);
  const auto noise = [&](double bound) { return bound * random(); };
  for (const double bound : {1e-9, 0.02}) {
    Family around_zero{{[&](double) { return Reading{noise(bound), bound}; }}};
    EXPECT_TRUE(around_zero.run(evenly(0, 50, 200)).empty());
    Family around_half{{[&](double x) { return Reading{0.5 + 0.003 * x + noise(bound), bound}; }}};
    EXPECT_TRUE(around_half.run(evenly(0, 50, 200)).empty());
    EXPECT_EQ(around_half.probes, 0);
  }
}

TEST(Detector, SaturatedReadingsCostNothing) {
  Family family{{exact([](double x) { return 1.0 - 4.0 / (4.0 + std::exp(3.0 * x)); }, 1e-15)}};
  EXPECT_TRUE(family.run(evenly(2, 20, 40)).empty());
  EXPECT_EQ(family.probes, 0);
}

TEST(Detector, TwoZerosOfOneFunctionInOneStep) {
  for (const double gap : {0.9, 0.4, 0.05, 1e-3, 1e-5}) {
    SCOPED_TRACE(testing::Message() << "zeros " << gap << " apart");
    const double first = 4.52 - 0.5 * gap;
    const double second = 4.52 + 0.5 * gap;
    Family family{{exact([=](double x) { return 0.05 * (x - first) * (x - second); }, 1e-15)}};
    expect_events(family.run({0, 1, 2, 3, 4, 5, 6, 7, 8}), {{0, first}, {0, second}});
    EXPECT_LE(family.probes, 10);
  }
}

TEST(Detector, TwoZerosInTheLastStep) {
  for (const double end : {4.75, 4.85, 5.0}) {
    Family family{{exact([](double x) { return 0.05 * (x - 4.45) * (x - 4.65); })}};
    expect_events(family.run({0, 1, 2, 3, 4, end}), {{0, 4.45}, {0, 4.65}});
  }
}

TEST(Detector, LastStepIsLookedIntoOnceMore) {
  // A dip that the points do not show; without a further point only the middle of the step is left to ask for.
  Family family{{exact([](double x) { return 0.04 * (1.0 - 1.2 * std::exp(-30.0 * (x - 4.45) * (x - 4.45))); })}};
  const double half = std::sqrt(std::log(1.2) / 30.0);
  expect_events(family.run({0, 1, 2, 3, 4, 5}), {{0, 4.45 - half}, {0, 4.45 + half}});
  EXPECT_EQ(family.probes, 1);
}

TEST(Detector, ThreeZerosInOneStepShowByTheirSurprise) {
  const auto bump = [](double x) { return std::clamp(1.0 - 4.0 * std::abs(x), 0.0, 1.0); };
  Family family{{exact([=](double x) { return 0.1 * (4.3 - x) + 0.6 * bump(x - 4.7); }, 1e-12)}};
  // Zeros at 4.3, where the bump outweighs the slope, and where it no longer does.
  const double second = (0.6 * (4.0 * 4.7 - 1.0) - 0.43) / (2.4 - 0.1);
  const double third = (0.6 * (1.0 + 4.0 * 4.7) + 0.43) / (2.4 + 0.1);
  expect_events(family.run({0, 1, 2, 3, 4, 4.7, 6, 7}), {{0, 4.3}, {0, second}, {0, third}});
}

TEST(Detector, CoarseStepIsSubdivided) {
  const double pi = std::numbers::pi;
  for (const int steps : {9, 14, 23, 60}) {
    SCOPED_TRACE(testing::Message() << steps << " steps");
    Family family{{exact([=](double x) { return std::cos(x); })}};
    std::vector<Event> events;
    for (int n = 0; n < 6; ++n) events.push_back({0, (n + 0.5) * pi});
    expect_events(family.run(evenly(0, 6 * pi, steps)), events);
    EXPECT_LE(family.probes, 70);
  }
}

// An index of 118 that is -10 within a step and 54 behind it: its reading goes from 0.967 to 0.929.
TEST(Detector, LargeIndexThatDipsWithinAStepIsSeen) {
  const auto index = [](double x) { return 118.0 - 128.0 * std::exp(-std::pow((x - 2.5) / (x < 2.5 ? 0.2 : 0.6), 2)); };
  Family family{{exact([&](double x) { return (index(x) - 2.0) / (std::abs(index(x)) + 2.0); })}};
  const double apart = std::sqrt(std::log(128.0 / 116.0));
  expect_events(family.run({0, 1, 2, 3, 4, 5}), {{0, 2.5 - 0.2 * apart}, {0, 2.5 + 0.6 * apart}});
  EXPECT_LE(family.probes, 12);
}

// What readings do not let expect, the length of the step does.
TEST(Detector, AStepIsHalvedAsOftenAsItSays) {
  const auto dip = [](double x) { return TestPoint{x, {{0.5 - 0.9 * std::exp(-100.0 * (x - 1.5) * (x - 1.5)), 0.0}}}; };
  for (const int halvings : {0, 1, 3}) {
    Detector detector;
    int probes = 0;
    std::vector<Bracket> found;
    for (const double x : {0.0, 1.0, 2.0}) {
      TestPoint point = dip(x);
      point.halvings = x > 1.0 ? halvings : 0;
      for (const Bracket& bracket : detector.advance(point, [&](double at) {
             ++probes;
             return std::optional(dip(at));
           }))
        found.push_back(bracket);
    }
    if (halvings == 0) {
      EXPECT_EQ(probes, 0);
      EXPECT_TRUE(found.empty());
    } else {
      EXPECT_GE(probes, halvings == 1 ? 1 : 7);
      EXPECT_EQ(found.size(), 2U) << halvings;
    }
  }
}

TEST(Detector, ZerosOfSeveralFunctionsInOneStep) {
  const auto step_like = [](double at) { return exact([at](double x) { return std::tanh(2.0 * (x - at)); }); };
  Family family{{step_like(4.1), step_like(4.5), step_like(4.55), exact([](double x) { return 0.1 * (x - 4.52); })}};
  expect_events(family.run(evenly(0, 9, 9)), {{0, 4.1}, {1, 4.5}, {2, 4.55}, {3, 4.52}});
}

TEST(Detector, BracketsComeByPosition) {
  Family family{{exact([](double x) { return 0.05 * (4.3 - x); }),
                 exact([](double x) { return 0.03 * (x - 4.02) * (x - 4.02); })}};
  expect_events(family.run(evenly(0, 9, 9)), {{0, 4.3}, {1, 4.02, true}});
}

TEST(Detector, SubdivisionIsBounded) {
  Family family{{exact([](double x) { return x < std::numbers::e ? -0.5 : 0.5; })}};
  const auto found = family.run(evenly(0, 10, 10));
  expect_events(found, {{0, std::numbers::e}});
  EXPECT_EQ(found[0].to - found[0].from, 1.0 / 8.0);
  EXPECT_GT(family.probes, 0);
  EXPECT_LE(family.probes, 3 * 3);
}

TEST(Detector, TouchingZeroIsATangency) {
  for (const double sign : {1.0, -1.0})
    for (const double at : {4.0, 4.1, 4.5, 4.97, 5.0 + 1e-7}) {
      SCOPED_TRACE(testing::Message() << sign << " at " << at);
      Family family{{exact([=](double x) { return sign * (1.0 - std::cos(0.7 * (x - at))) / 2.0; }, 1e-10)}};
      const auto found = family.run({0.2, 1, 2, 3, 4, 5, 6, 7, 8});
      expect_events(found, {{0, at, true}});
      EXPECT_LE(found[0].to - found[0].from, 2.0);
      EXPECT_LE(family.probes, 45);
    }
}

TEST(Detector, TouchIsSeenThroughNoiseAndFromItsOwnStation) {
  numerics::Random random(7);
  const auto noisy = [&](double x) { return Reading{0.05 * (x - 4.2) * (x - 4.2) + 1e-7 * random(), 1e-7}; };
  Family rough{{noisy}};
  expect_events(rough.run({0.5, 1, 2, 3, 4, 5, 6, 7, 8}), {{0, 4.2, true}});
  // So narrow that only one point shows it.
  Family narrow{{exact([](double x) { return 0.004 * (1.0 - std::exp(-20.0 * (x - 4.0) * (x - 4.0))); })}};
  expect_events(narrow.run({0, 1, 2, 3, 4, 5, 6, 7, 8}), {{0, 4.0, true}});
}

TEST(Detector, MinimumAboveZeroIsNoEvent) {
  for (const double least : {0.3, 0.05, 1e-2, 1e-4, 1e-5}) {
    Family family{{exact([=](double x) { return least + 0.04 * (x - 4.2) * (x - 4.2); })}};
    EXPECT_TRUE(family.run({0.5, 1, 2, 3, 4, 5, 6, 7, 8}).empty()) << least;
    if (least == 0.3) {
      EXPECT_EQ(family.probes, 0);
    }
  }
}

// Orbits are not isolated on a zero: that is where none is to be had.
TEST(Detector, MinimumWithoutAnOrbitIsLeftToItsLocation) {
  for (const double least : {0.0, 1e-5}) {
    Family family{{exact([=](double x) { return least + 0.05 * (x - 4.2) * (x - 4.2); })}};
    std::vector<Bracket> found;
    for (const double x : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0})
      for (const Bracket& bracket : family.detector.advance(family.point(x), [&](double at) {
             return std::abs(at - 4.2) < 0.01 ? std::nullopt : std::optional(family.point(at));
           }))
        found.push_back(bracket);
    expect_events(found, {{0, 4.2, true}});
  }
}

TEST(Detector, UncertainMinimumShowsNothing) {
  Family family{{exact([=](double x) { return 0.05 * (x - 4.2) * (x - 4.2); }, 1e-3)}};
  EXPECT_TRUE(family.run({0.5, 1, 2, 3, 4, 5, 6, 7, 8}).empty());
}

TEST(Detector, DipBesideACrossingIsSeen) {
  for (const double size : {0.02, 0.002}) {
    Family family{{exact([=](double x) { return size * (x - 3.3) * (x - 4.5) * (x - 4.7); }, 1e-13)}};
    expect_events(family.run({2, 3, 4, 5, 6, 7}), {{0, 3.3}, {0, 4.5}, {0, 4.7}});
  }
}

TEST(Detector, FindsWhatADenseSamplingFinds) {
  // Sums of five cosines with periods from 4 to 20, seen through three test functions at uneven steps of 0.5 to 1.5.
  numerics::Random symmetric(3);
  const auto random = [&] { return 0.5 + 0.5 * symmetric(); };
  std::size_t zeros = 0;
  for (int run = 0; run < 40; ++run) {
    std::vector<double> draws(15);
    for (double& draw : draws) draw = random();
    const auto index = [=](double x) {
      double sum = 0.0;
      for (std::size_t n = 0; n < 15; n += 3)
        sum += (6.0 * draws[n] - 3.0) * std::cos((0.3 + 1.2 * draws[n + 1]) * x + 6.3 * draws[n + 2]);
      return sum;
    };
    Family family;
    for (const double c : {2.0, 0.0, -1.0})
      family.functions.push_back(exact([=](double x) { return (index(x) - c) / (2.0 + std::abs(index(x))); }));
    std::vector<double> positions{0.0};
    while (positions.back() < 40.0) positions.push_back(positions.back() + 0.5 + random());
    std::vector<Event> events;
    for (std::size_t f = 0; f < 3; ++f) {
      const double width = positions.back() / 20000.0;
      for (int n = 0; n < 20000; ++n) {
        const auto root = numerics::locate_root([&](double x) { return family.functions[f](x).value; }, n * width,
                                                (n + 1) * width, 1e-13);
        if (root) events.push_back({f, root->position});
      }
    }
    expect_events(family.run(positions), events);
    zeros += events.size();
  }
  EXPECT_GT(zeros, 1000u);
}

TEST(Detector, MissingProbesLeaveWhatTheStationsShow) {
  Family family{{exact([](double x) { return std::cos(x); })}};
  std::vector<Bracket> found;
  for (const double x : evenly(0, 6, 6))
    for (const Bracket& bracket : family.detector.advance(family.point(x), [](double) { return std::nullopt; }))
      found.push_back(bracket);
  expect_events(found, {{0, 0.5 * std::numbers::pi}, {0, 1.5 * std::numbers::pi}});
}

TEST(Detector, GoesOnFromItsStateAsIfItHadNotStopped) {
  const Functions functions{exact([](double x) { return std::cos(x); }),
                            exact([](double x) { return 0.5 - 0.5 * std::sin(0.6 * x); })};
  Family whole{functions};
  const auto positions = evenly(0, 20, 26);
  const auto expected = whole.run(positions);
  EXPECT_GE(expected.size(), 8u);
  for (std::size_t stop = 1; stop < positions.size(); ++stop) {
    Family first{functions};
    std::vector<Bracket> found;
    for (std::size_t n = 0; n < stop; ++n)
      for (const Bracket& bracket : first.advance(positions[n])) found.push_back(bracket);
    Family second{functions, Detector(first.detector.state(), {})};
    second.last = first.last;
    second.earlier = first.earlier;
    for (const Bracket& bracket : second.run({positions.begin() + static_cast<std::ptrdiff_t>(stop), positions.end()}))
      found.push_back(bracket);
    ASSERT_EQ(found.size(), expected.size()) << "stopped after " << stop;
    for (std::size_t n = 0; n < found.size(); ++n) {
      EXPECT_EQ(found[n].function, expected[n].function);
      EXPECT_EQ(found[n].from, expected[n].from);
      EXPECT_EQ(found[n].to, expected[n].to);
      EXPECT_EQ(found[n].tangency, expected[n].tangency);
    }
  }
}

TEST(Detector, MisuseIsRefused) {
  const auto none = [](double) { return std::nullopt; };
  Detector detector;
  (void)detector.advance({1.0, {{0.5, 0.0}}}, none);
  EXPECT_THROW((void)detector.advance({1.0, {{0.5, 0.0}}}, none), core::MisuseError);
  EXPECT_THROW((void)detector.advance({2.0, {}}, none), core::MisuseError);
  const auto wrong = [](double x) { return TestPoint{x, {}}; };
  EXPECT_THROW((void)detector.advance({2.0, {{-0.9, 0.0}}}, wrong), core::MisuseError);
}

}  // namespace
}  // namespace detector_test
