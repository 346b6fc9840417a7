// Families in a parameter: T and the parameter are solved for, at every orbit of a curve.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "families.hpp"
#include "orbweaver/starts/equilibrium_curve.hpp"
#include "support/lorenz_equations.hpp"
#include "support/van_der_pol.hpp"

namespace orbweaver::test::parameter_test {
namespace {

using continuation::EndReason;

/// At mu = 0 every circle is an orbit; the cycle of mu > 0 leaves that of radius 2.
continuation::Start circle() {
  continuation::Start start;
  start.base = loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, 10);
  start.base.parameters = {0.0};
  start.base.cosine(1, 0) = 2.0;
  start.base.sine(1, 1) = -2.0;
  start.direction = {std::vector<double>(start.base.modes.size(), 0.0), {0.0, 1.0}};
  return start;
}

continuation::Options to(double parameter) {
  continuation::Options options;
  options.parameter_to = parameter;
  options.start_amplitude = 0.1;
  return options;
}

TEST(VanDerPolFamily, HasTheKnownPeriods) {
  const auto system = std::make_shared<VanDerPol>(0.0, systems::FamilyScalars{{"mu"}, {}});
  for (const auto& [mu, period] : {std::pair(1.0, 6.663286859323130), std::pair(10.0, 19.07836956694)}) {
    const Trace trace = trace_of(system, circle(), to(mu));
    EXPECT_EQ(trace.ending.reason, EndReason::parameter_limit) << trace.ending.text();
    ASSERT_FALSE(trace.orbits.empty());
    EXPECT_EQ(trace.last().loop.parameters, std::vector<double>{mu});
    EXPECT_NEAR(trace.last().loop.period, period, 1e-11);
    printf("%zu orbits, K %d, T %.15g loss %.2g %s\n", trace.orbits.size(), trace.last().loop.cutoff,
           trace.last().loop.period, trace.last().loss_rms, trace.ending.text().c_str());
  }
}

/// From the Hopf point of the upper right equilibrium. The family is unstable, and ends where its orbit meets the
/// origin.
TEST(LorenzFamily, GoesFromTheHopfPointToTheHomoclinicOrbit) {
  const auto system = std::make_shared<LorenzEquations>(24.0);
  const auto curve = starts::follow_equilibrium(*system, std::vector<double>{8.0, 8.0, 23.0},
                                                {.parameter_from = 2.0, .parameter_to = 30.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  const starts::HopfPoint& hopf = curve.hopf.front();
  continuation::Start start{loop::constant_loop(hopf.at.state, hopf.period, 10), hopf.direction, hopf.isotropy};
  start.base.parameters = {hopf.at.parameter};
  continuation::Options options;
  options.period_limit = 20.0;
  const Trace trace = trace_of(system, start, options);
  printf("%zu orbits, K %d, T %.15g rho %.15g loss %.2g %s\n", trace.orbits.size(), trace.last().loop.cutoff,
         trace.last().loop.period, trace.last().loop.parameters[0], trace.last().loss_rms, trace.ending.text().c_str());
  EXPECT_NEAR(trace.last().loop.parameters.front(), 13.926557, 1e-6);
}

}  // namespace
}  // namespace orbweaver::test::parameter_test
