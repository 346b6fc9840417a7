#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/slopes.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "support/delegating_system.hpp"

namespace crossing_test {
namespace {

using namespace orbweaver;
using bifurcation::Event;
using bifurcation::Sector;

/// The orbits of a traced family around the period, as a survey hands them to a location.
struct Curve : continuation::FamilyCurve {
  Curve(const test::Trace& family, double period);
};

Curve::Curve(const test::Trace& family, double period)
    : FamilyCurve(test::pendulum(), test::pendulum_isotropy(*test::pendulum()), {}) {
  std::size_t after = 0;
  while (family.orbits[after].loop.period < period) ++after;
  for (std::size_t n = after < 3 ? 0 : after - 3; n <= std::min(after + 1, family.orbits.size() - 1); ++n)
    add(family.orbits[n].arclength, family.orbits[n].loop);
}

struct Expected {
  double period;
  Sector sector;
  int dimension;
  int multiplicity;
};

void expect_crossing(const test::PendulumMode& mode, const Expected& expected) {
  SCOPED_TRACE(expected.period);
  Curve curve(test::family_to_twelve(mode), expected.period);
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, expected.sector}, false};
  bifurcation::NotLocated why;
  const auto found = bifurcation::locate(*test::pendulum(), curve, event, curve.known().front().position,
                                         curve.known().back().position, why);
  ASSERT_TRUE(found) << to_text(why);
  EXPECT_NEAR(found->point.loop.period, expected.period, 1e-9);
  const bifurcation::Reading deviation =
      bifurcation::index_deviation(test::pendulum()->structure(), found->stability, expected.sector);
  EXPECT_LE(std::abs(deviation.value), std::max(1e-9, deviation.error));
  const bifurcation::Kernel kernel = bifurcation::kernel_of(*test::pendulum(), found->point, curve.isotropy(),
                                                            expected.sector, expected.sector.q <= 2 ? 1 : 2);
  EXPECT_EQ(kernel.dimension(), expected.dimension);
  EXPECT_LT(kernel.largest(), 1e-8);
  EXPECT_GT(kernel.next(), 1e3 * kernel.largest());
  EXPECT_NEAR(kernel.base.period, expected.multiplicity * expected.period, 1e-8);
  if (expected.multiplicity > 1) return;
  const bifurcation::Kernel mapped = bifurcation::kernel_of(
      *test::pendulum(), found->point, curve.isotropy(), expected.sector, expected.dimension, {.even_in_time = false});
  EXPECT_EQ(mapped.dimension(), expected.dimension) << "under the orbit's own time map";
  EXPECT_LT(mapped.largest(), 1e-8);
  EXPECT_LE(mapped.base.cutoff, kernel.base.cutoff);
}

TEST(Crossings, OfTheInPhaseFamily) {
  expect_crossing(test::in_phase(), {8.442930704977588, {4, 1}, 2, 2});
  expect_crossing(test::in_phase(), {10.416773281973249, {1, 0}, 1, 1});
}

TEST(Crossings, OfTheOutPhaseFamily) { expect_crossing(test::out_phase(), {4.059557792801163, {4, 1}, 2, 2}); }

TEST(Crossings, AZeroThatIsNotThereIsSaid) {
  Curve curve(test::family_to_twelve(test::in_phase()), 9.0);
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {1, 0}}, false};
  bifurcation::NotLocated why;
  const auto& known = curve.known();
  EXPECT_FALSE(bifurcation::locate(*test::pendulum(), curve, event, known[2].position, known[3].position, why));
  EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_zero);
  EXPECT_NE(to_text(why).find("no zero between"), std::string::npos);
}

TEST(Crossings, AtABirthTheIndexNearestToTwoIsTwo) {
  spectrum::Stability stability;
  stability.fundamental = {-130.0, 1e9};
  stability.fundamental_error = {1e5, 1e5};
  bifurcation::tell_birth(test::pendulum()->structure(), stability);
  EXPECT_EQ(stability.fundamental[0], 2.0);
  EXPECT_EQ(stability.fundamental[1], 1e9);
  EXPECT_EQ(stability.fundamental_error, (std::vector<double>{0.0, 0.0}));
}

// From a birth the index falls from 2, however it is computed there; but not by a jump that it is known to make.
TEST(Crossings, AJumpFromABirthIsNoCrossing) {
  const double period = 8.442930704977588;
  Curve curve(test::family_to_twelve(test::in_phase()), period);
  Event event{.function = {bifurcation::TestFunction::Kind::sector, {4, 1}}};
  const auto& known = curve.known();
  const auto after = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.loop.period > period; });
  ASSERT_GE(after - known.begin(), 2);
  ASSERT_GE(known.end() - after, 2);
  int negative = 0;
  for (const auto from : {after - 2, after}) {
    const spectrum::Stability stability = spectrum::floquet(*test::pendulum(), from->loop, curve.isotropy(), {});
    if (bifurcation::evaluate(event.function, test::pendulum()->structure(), stability).sign() > 0) continue;
    ++negative;
    bifurcation::NotLocated why;
    event.from_birth = false;
    EXPECT_FALSE(bifurcation::locate(*test::pendulum(), curve, event, from->position, (from + 1)->position, why));
    EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_zero);
    event.from_birth = true;
    EXPECT_FALSE(bifurcation::locate(*test::pendulum(), curve, event, from->position, (from + 1)->position, why));
    EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_crossing) << to_text(why);
  }
  EXPECT_EQ(negative, 1);
}

TEST(Crossings, WithoutAnOrbitThePlaceIsSaid) {
  continuation::FamilyCurve curve(test::pendulum(), test::pendulum_isotropy(*test::pendulum()), {});
  curve.add(0.0, test::orbit_at(test::family_to_twelve(test::in_phase()), 8.3).loop);
  curve.add(1.0, test::orbit_at(test::family_to_twelve(test::out_phase()), 8.3).loop);
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {1, 0}}, false};
  bifurcation::NotLocated why;
  EXPECT_FALSE(bifurcation::locate(*test::pendulum(), curve, event, 0.25, 0.75, why));
  EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_orbit);
  EXPECT_EQ(to_text(why), "no orbit converges at position 0.75, after the one with T = 8.3");
}

/// The pendulum, whose derivatives are not finite.
class WithoutDerivatives final : public test::DelegatingSystem {
 public:
  WithoutDerivatives() : DelegatingSystem(test::pendulum()) {}
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, z, f, jacobian);
    std::fill_n(jacobian, 16 * nodes, std::nan(""));
  }
};

TEST(Crossings, WithoutMultipliersTheOrbitAndTheReasonAreSaid) {
  const auto system = std::make_shared<const WithoutDerivatives>();
  continuation::FamilyCurve curve(system, test::pendulum_isotropy(*system), {});
  curve.add(0.0, test::orbit_at(test::family_to_twelve(test::in_phase()), 8.3).loop);
  curve.add(1.0, test::orbit_at(test::family_to_twelve(test::in_phase()), 8.4).loop);
  const Event event{Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {1, 0}}, false};
  bifurcation::NotLocated why;
  EXPECT_FALSE(bifurcation::locate(*system, curve, event, 0.0, 1.0, why));
  EXPECT_EQ(why.reason, bifurcation::NotLocated::Reason::no_multipliers);
  EXPECT_NE(to_text(why).find("no multipliers of the orbit with T = 8.4 at position 1: "), std::string::npos)
      << to_text(why);
  EXPECT_NE(to_text(why).find("finite"), std::string::npos) << to_text(why);
}

TEST(FamilyCurve, AKnownOrbitIsThereWithoutTheCorrector) {
  continuation::Options options;
  options.corrector.method = corrector::Method::rprop;
  options.corrector.max_iterations = 1;
  continuation::FamilyCurve curve(test::pendulum(), test::pendulum_isotropy(*test::pendulum()), options);
  const loop::Loop from = test::orbit_at(test::family_to_twelve(test::in_phase()), 8.3).loop;
  const loop::Loop to = test::orbit_at(test::family_to_twelve(test::in_phase()), 8.4).loop;
  curve.add(0.0, from);
  curve.add(1.0, to);
  EXPECT_FALSE(curve.at(0.5));
  const auto a = curve.at(0.0, true);
  const auto b = curve.at(1.0);
  ASSERT_TRUE(a && b);
  EXPECT_LT(loop::mean_distance(a->loop, from), 1e-10);
  EXPECT_LT(loop::mean_distance(b->loop, to), 1e-10);
  EXPECT_GT(bifurcation::period_slope(*a), 0.0);
}

TEST(FamilyCurve, AnOrbitDoesNotDependOnWhatWasAskedBefore) {
  const test::Trace& family = test::family_to_twelve(test::in_phase());
  Curve once(family, 9.0);
  Curve often(family, 9.0);
  const double from = once.known()[2].position;
  const double to = once.known()[3].position;
  for (const double share : {0.1, 0.7, 0.45, 0.43}) ASSERT_TRUE(often.at(from + share * (to - from)));
  const double position = from + 0.44 * (to - from);
  const auto a = once.at(position);
  const auto b = often.at(position);
  ASSERT_TRUE(a && b);
  EXPECT_LT(loop::mean_distance(a->loop, b->loop), 1e-11);
  EXPECT_NEAR(a->loop.period, b->loop.period, 1e-11);
}

TEST(FamilyCurve, TheTangentPointsAlongTheFamily) {
  Curve curve(test::family_to_twelve(test::in_phase()), 9.0);
  const double from = curve.known()[2].position;
  const double step = 1e-4;
  const auto a = curve.at(from + 0.05, true);
  const auto b = curve.at(from + 0.05 + step);
  ASSERT_TRUE(a && b);
  // dT and dE in the direction of the tangent, against differences along the curve.
  const double period_change = b->loop.period - a->loop.period;
  const double energy_change =
      continuation::energy_of(*test::pendulum(), b->loop) - continuation::energy_of(*test::pendulum(), a->loop);
  EXPECT_NEAR(bifurcation::energy_slope(*test::pendulum(), *a) / bifurcation::period_slope(*a),
              energy_change / period_change, 1e-3 * std::abs(energy_change / period_change));
  EXPECT_GT(bifurcation::period_slope(*a), 0.0);
}

TEST(FamilyCurve, RefusesOrbitsFarFromTheChord) {
  // No family leads from the in-phase to the out-phase orbit of T = 8.3; what Newton's method finds from points
  // between them lies elsewhere.
  for (const corrector::Method method : {corrector::Method::automatic, corrector::Method::newton_krylov}) {
    continuation::Options options;
    options.corrector.method = method;
    continuation::FamilyCurve curve(test::pendulum(), test::pendulum_isotropy(*test::pendulum()), options);
    curve.add(0.0, test::orbit_at(test::family_to_twelve(test::in_phase()), 8.3).loop);
    curve.add(1.0, test::orbit_at(test::family_to_twelve(test::out_phase()), 8.3).loop);
    EXPECT_FALSE(curve.at(0.25));
  }
}

TEST(FamilyCurve, NothingBeyondItsEnds) {
  Curve curve(test::family_to_twelve(test::in_phase()), 9.0);
  EXPECT_THROW((void)curve.at(curve.known().back().position + 0.1), core::MisuseError);
}

}  // namespace
}  // namespace crossing_test
