// Curves of folds and period doublings in two parameters, against crossings located at fixed values of one.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/locus.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/locus_curve.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::test::locus_tests {
namespace {

using bifurcation::Event;
using continuation::LocusPoint;

/// Duffing's oscillator with damping and drive.
std::shared_ptr<const systems::System> duffing(std::vector<std::string> free, double amplitude, double damping = 0.1) {
  return systems::make_system("duffing",
                              {{"damping", damping}, {"drive_amplitude", amplitude}, {"drive_frequency", 0.5}},
                              {"damping", "drive"}, {std::move(free), {}});
}

/// At rest without a drive; the drive's amplitude is raised, then the frequency, or the other way.
loop::Loop response(double frequency, double amplitude, double damping = 0.1) {
  loop::Loop loop = loop::constant_loop(std::vector<double>(3, 0.0), 2.0 * std::numbers::pi / frequency, 15);
  loop.winding = {0.0, 0.0, 1.0};
  loop.parameters = {0.0};
  const auto system =
      systems::make_system("duffing", {{"damping", damping}, {"drive_amplitude", 0.0}, {"drive_frequency", frequency}},
                           {"damping", "drive"}, {{"drive_amplitude"}, {}});
  continuation::Start start{loop, {std::vector<double>(loop.modes.size(), 0.0), {0.0, 1.0}}, {}, true};
  start.isotropy = loop::find_isotropy(system->structure(), loop, loop::symmetry_tolerance);
  continuation::Options options;
  options.parameter_to = amplitude;
  loop::Loop last;
  (void)continuation::trace(system, start, options, [&](const continuation::Orbit& orbit) {
    last = orbit.loop;
    return true;
  });
  EXPECT_EQ(last.parameters.front(), amplitude);
  last.parameters = {frequency};
  return last;
}

struct Found {
  bifurcation::Crossing crossing;
  loop::Isotropy isotropy;
};

/// The crossings of the response curve of this amplitude.
std::vector<Found> folds(double amplitude, double largest_step = 1.0) {
  const auto system = duffing({"drive_frequency"}, amplitude);
  const loop::Loop first = response(0.5, amplitude);
  continuation::Start start{first, {std::vector<double>(first.modes.size(), 0.0), {0.0, 1.0}}, {}, true};
  start.isotropy = loop::find_isotropy(system->structure(), first, loop::symmetry_tolerance);
  continuation::Options options;
  options.parameter_from = 0.3;
  options.parameter_to = 3.0;
  options.largest_step = largest_step;
  continuation::FamilyCurve curve(system, start.isotropy, options);
  bifurcation::FoldWatch watch;
  std::vector<bifurcation::Fold> seen;
  (void)continuation::trace(system, start, options, [&](const continuation::Orbit& orbit) {
    curve.add(orbit.arclength, orbit.loop, 100000);
    for (const bifurcation::Fold& fold :
         watch.advance(orbit.arclength, orbit.loop.period, orbit.energy, orbit.loop.parameters.front()))
      if (fold.quantity == bifurcation::Fold::Quantity::parameter) seen.push_back(fold);
    return true;
  });
  std::vector<Found> found;
  for (const bifurcation::Fold& fold : seen) {
    bifurcation::NotLocated why;
    auto crossing =
        bifurcation::locate(*system, curve, {Event::Kind::fold_parameter, {}, false}, fold.from, fold.to, why);
    EXPECT_TRUE(crossing) << to_text(why);
    if (crossing) found.push_back({std::move(*crossing), start.isotropy});
  }
  return found;
}

/// The locus to one side of a crossing at which the second parameter is `value`.
continuation::Locus locus_of(const std::shared_ptr<const systems::System>& surface, const Found& from,
                             const Event& event, double value, int side, const continuation::LocusOptions& options) {
  loop::Loop start = from.crossing.point.loop;
  start.parameters.push_back(value);
  return continuation::follow_locus(surface, from.isotropy, start, from.crossing.point.tangent,
                                    locus_test(*surface, from.isotropy, event), side, options);
}

constexpr Event parameter_fold{Event::Kind::fold_parameter, {}, false};

TEST(DuffingFolds, MeetInACusp) {
  const auto surface = duffing({"drive_frequency", "drive_amplitude"}, 0.3);
  const std::vector<Found> both = folds(0.3);
  ASSERT_EQ(both.size(), 2U);
  continuation::LocusOptions options;
  options.branch.parameter_to = 3.0;
  options.from = 0.01;
  options.to = 0.5;
  const continuation::Locus up = locus_of(surface, both[0], parameter_fold, 0.3, -1, options);
  EXPECT_EQ(up.ending.reason, continuation::EndReason::parameter_limit) << up.ending.text();
  ASSERT_FALSE(up.points.empty());
  EXPECT_NEAR(up.points.back().loop.parameters[1], 0.5, 1e-11);
  const continuation::Locus locus = locus_of(surface, both[0], parameter_fold, 0.3, 1, options);
  EXPECT_EQ(locus.ending.reason, continuation::EndReason::parameter_limit) << locus.ending.text();
  // It passes through the cusp to the other fold.
  std::vector<LocusPoint> cusps, returns, others;
  for (const LocusPoint& point : locus.points)
    (point.is_cusp ? cusps : point.is_return ? returns : others).push_back(point);
  ASSERT_EQ(cusps.size(), 1U);
  ASSERT_EQ(returns.size(), 1U);
  EXPECT_NEAR(returns[0].loop.parameters[0], both[1].crossing.point.loop.parameters[0], 1e-8);
  EXPECT_NEAR(returns[0].loop.parameters[1], 0.3, 1e-11);
  // Five points of either part, against the folds of their response curves.
  int compared = 0;
  for (std::size_t n = 2; n < others.size(); n += 4) {
    const std::vector<double>& at = others[n].loop.parameters;
    SCOPED_TRACE(at[1]);
    const bool first = others[n].arclength < cusps[0].arclength;
    const std::vector<Found> direct = folds(at[1]);
    ASSERT_EQ(direct.size(), 2U);
    EXPECT_NEAR(at[0], direct[first ? 0 : 1].crossing.point.loop.parameters[0], 1e-8);
    ++compared;
  }
  EXPECT_GE(compared, 5);
  // Response curves have two folds on one side of the cusp, which part with the power 3/2, and none on the other.
  const std::vector<double>& cusp = cusps[0].loop.parameters;
  EXPECT_TRUE(folds(cusp[1] * (1.0 - 1e-3), 0.02).empty());
  const std::vector<Found> near = folds(cusp[1] * (1.0 + 1e-2), 0.02);
  const std::vector<Found> nearer = folds(cusp[1] * (1.0 + 2.5e-3), 0.02);
  ASSERT_EQ(near.size(), 2U);
  ASSERT_EQ(nearer.size(), 2U);
  const auto apart = [](const std::vector<Found>& two) {
    return std::abs(two[0].crossing.point.loop.parameters[0] - two[1].crossing.point.loop.parameters[0]);
  };
  EXPECT_NEAR(apart(near) / apart(nearer), 8.0, 0.1);
}

// Any function of the orbit has a curve where it vanishes. This one's is a hyperbola in the plane of the parameters: it
// turns by a right angle within a step, so that points before do not tell the way.
TEST(Locus, FollowsASharpBend) {
  const auto surface = duffing({"drive_frequency", "drive_amplitude"}, 0.3);
  constexpr double corner = 0.7;
  const loop::Loop first = response(0.9, 0.3);
  Found start{};
  start.crossing.point = {0.0, first, {std::vector<double>(first.modes.size(), 0.0), {0.0, 1.0}}};
  start.isotropy = loop::find_isotropy(surface->structure(), first, loop::symmetry_tolerance);
  continuation::LocusOptions options;
  options.branch.parameter_from = 0.5;
  options.branch.parameter_to = 0.95;
  options.from = 0.01;
  options.to = 0.5;
  for (const double width : {1e-2, 1e-3, 1e-5}) {
    SCOPED_TRACE(width);
    const auto amplitude_at = [width](double frequency) {
      return 0.3 + std::hypot(frequency - corner, width) - std::hypot(0.9 - corner, width);
    };
    continuation::LocusTest test;
    test.value = [&](const loop::Loop& l) { return l.parameters[1] - amplitude_at(l.parameters[0]); };
    loop::Loop at = first;
    at.parameters.push_back(0.3);
    const continuation::Locus locus =
        continuation::follow_locus(surface, start.isotropy, at, start.crossing.point.tangent, test, 1, options);
    EXPECT_EQ(locus.ending.text(), "parameter limit (drive_frequency = 0.5)");
    for (const LocusPoint& point : locus.points)
      EXPECT_NEAR(point.loop.parameters[1], amplitude_at(point.loop.parameters[0]), 1e-10);
  }
}

// A circle in the plane of the parameters.
TEST(Locus, EndsWhereItBegan) {
  const auto surface = duffing({"drive_frequency", "drive_amplitude"}, 0.3);
  const loop::Loop first = response(0.9, 0.3);
  const loop::Isotropy isotropy = loop::find_isotropy(surface->structure(), first, loop::symmetry_tolerance);
  constexpr double radius = 0.1;
  const auto radius_at = [](const loop::Loop& l) { return std::hypot(l.parameters[0] - 0.8, l.parameters[1] - 0.3); };
  continuation::LocusTest test;
  test.value = [&](const loop::Loop& l) { return radius_at(l) - radius; };
  loop::Loop at = first;
  at.parameters.push_back(0.3);
  continuation::LocusOptions options;
  options.largest_step = 0.05;
  options.branch.step_limit = 100;
  const continuation::Locus locus = continuation::follow_locus(
      surface, isotropy, at, {std::vector<double>(first.modes.size(), 0.0), {0.0, 1.0}}, test, 1, options);
  EXPECT_EQ(locus.ending.text(), "closed loop (back at the start)");
  ASSERT_GT(locus.points.size(), 4U);
  for (const LocusPoint& point : locus.points) EXPECT_NEAR(radius_at(point.loop), radius, 1e-10);
  EXPECT_TRUE(locus.points.back().is_return);
  EXPECT_NEAR(locus.points.back().loop.parameters[0], 0.9, 1e-9);
}

std::shared_ptr<const systems::System> pendulum_of(double m2, std::vector<std::string> free = {}) {
  return systems::make_system("double_pendulum", {{"m2", m2}}, {}, {std::move(free), {}});
}

/// In-Phase's first doubling between two orbits about `near`.
Found doubling(double m2, const loop::Loop& near, double period) {
  const auto system = pendulum_of(m2);
  const loop::Isotropy isotropy = pendulum_isotropy(*system);
  continuation::FamilyCurve curve(system, isotropy, {});
  double position = 0.0;
  for (const double off : {-0.02, 0.03}) {
    const auto orbit = continuation::orbit_at_period(*system, near, isotropy, period + off, {});
    EXPECT_TRUE(orbit.converged()) << orbit.detail;
    curve.add(position, orbit.loop);
    position += 1.0;
  }
  bifurcation::NotLocated why;
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {4, 1}}, false};
  auto found = bifurcation::locate(*system, curve, event, 0.0, 1.0, why);
  EXPECT_TRUE(found) << to_text(why);
  return {std::move(*found), isotropy};
}

TEST(InPhase, FirstDoublingInPeriodAndMass) {
  const Found start = doubling(1.0, orbit_at(family_to_twelve(in_phase()), 8.44).loop, 8.44);
  EXPECT_NEAR(start.crossing.point.loop.period, 8.442930704977588, 1e-9);
  continuation::LocusOptions options;
  options.branch.period_limit = 12.0;
  options.from = 0.25;
  options.to = 4.0;
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {4, 1}}, false};
  int compared = 0;
  // One way the orbits shrink to rest; beyond lie the same half a period later.
  constexpr int to_equilibrium = 1;
  constexpr double small = 0.5;
  for (const int side : {1, -1}) {
    const continuation::Locus locus = locus_of(pendulum_of(1.0, {"m2"}), start, event, 1.0, side, options);
    EXPECT_EQ(locus.ending.reason,
              side == to_equilibrium ? continuation::EndReason::fixed_point : continuation::EndReason::period_limit)
        << locus.ending.text();
    // There the other oscillation has 5/2 of its frequency.
    if (side == to_equilibrium) {
      EXPECT_EQ(locus.ending.detail.rfind("near T = 8.2502", 0), 0U) << locus.ending.text();
    }
    ASSERT_GE(locus.points.size(), 4U);
    for (std::size_t n = 1; n + 1 < locus.points.size(); n += std::max<std::size_t>(1, locus.points.size() / 6)) {
      const LocusPoint& point = locus.points[n];
      if (loop::rms_amplitude(point.loop) < small) continue;  // no orbit has a period below that of the oscillation
      const double m2 = point.loop.parameters.front();
      SCOPED_TRACE(m2);
      loop::Loop near = point.loop;
      near.parameters.clear();
      EXPECT_NEAR(doubling(m2, near, point.loop.period).crossing.point.loop.period, point.loop.period, 1e-8);
      ++compared;
    }
  }
  EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace orbweaver::test::locus_tests
