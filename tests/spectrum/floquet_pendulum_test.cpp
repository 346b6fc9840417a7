// Indices of the double pendulum's orbits against a computation in quadruple precision.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "floquet_chain.hpp"
#include "floquet_indices.hpp"
#include "matrix_table.hpp"
#include "orbit_correction.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "spectrum/floquet_checks.hpp"
#include "spectrum/pendulum_loops.hpp"
#include "support/relative_error.hpp"
#include "transverse_flow.hpp"

namespace floquet_pendulum_test {
namespace {

using namespace orbweaver;
using spectrum::floquet;
using spectrum::Stability;
using test::expect_value;
using test::pendulum;

/// Index of the half map, from the quarter period in quadruple precision: Newton's method for the brake point, then the
/// variational equations over T/2, both by extrapolation of order 28.
struct Reference {
  double period;
  double half;
};

const test::PendulumMode in_phase = test::in_phase();
const test::PendulumMode out_phase = test::out_phase();

const std::vector<std::pair<test::PendulumMode, std::vector<Reference>>>& references() {
  static const std::vector<std::pair<test::PendulumMode, std::vector<Reference>>> values{
      {in_phase,
       {{10, 0.42291741949564062723},
        {12, 22.51995452980667673},
        {15, 487.8659911195891725},
        {20, 51448.89227678537374},
        {25, 5204249.2959117992849},
        {30, 527226838.35986035954}}},
      {out_phase,
       {{10, 21.005000473163432573},
        {12, 34.121066340644482443},
        {15, 109.94097026761256372},
        {20, 1656.1746453733551512},
        {25, 102226.39487676922241},
        {30, 9910171.6656704076902}}}};
  return values;
}

std::vector<continuation::Orbit> family_to_thirty(const test::PendulumMode& mode) {
  continuation::Options options;
  options.fit_time_map = false;
  options.period_limit = 30.5;
  return test::trace_of(mode, options).orbits;
}

loop::Loop orbit_at(const std::vector<continuation::Orbit>& family, double period) {
  const auto nearest = std::min_element(family.begin(), family.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.loop.period - period) < std::abs(b.loop.period - period);
  });
  return continuation::orbit_at_period(*pendulum(), nearest->loop, test::pendulum_isotropy(*pendulum()), period, {})
      .loop;
}

/// Each orbit with its true index, once a process.
const std::vector<std::pair<loop::Loop, Reference>>& pendulum_orbits() {
  static const std::vector<std::pair<loop::Loop, Reference>> orbits = [] {
    std::vector<std::pair<loop::Loop, Reference>> found;
    for (const auto& [mode, values] : references()) {
      const std::vector<continuation::Orbit> family = family_to_thirty(mode);
      for (const Reference& reference : values) found.emplace_back(orbit_at(family, reference.period), reference);
    }
    return found;
  }();
  return orbits;
}

double full_of(double half) { return half * half - 2.0; }

TEST(PendulumIndex, HoldsItsDigitsUpToTenToTheEighteen) {
  const loop::Isotropy symmetric = test::pendulum_isotropy(*pendulum());
  ASSERT_EQ(loop::to_text(symmetric), "S@1/2 R@0");
  double largest = 0.0;
  for (const auto& [loop, reference] : pendulum_orbits()) {
    const double goal = reference.period <= 15 ? 1e-11 : 1e-10;
    const loop::Isotropy parts[] = {symmetric, {symmetric[0]}, {symmetric[1]}, {}};
    for (const loop::Isotropy& isotropy : parts) {
      SCOPED_TRACE(testing::Message() << "T = " << reference.period << ", isotropy " << loop::to_text(isotropy));
      const Stability stability = floquet(*pendulum(), loop, isotropy);
      ASSERT_EQ(stability.full.size(), 1u);
      expect_value(stability.full[0], stability.full_error[0], full_of(reference.half), goal);
      const bool halved = !isotropy.empty() && !isotropy[0].reversing;
      ASSERT_EQ(stability.fundamental_order, halved ? 2 : 1);
      expect_value(stability.fundamental[0], stability.fundamental_error[0],
                   halved ? reference.half : full_of(reference.half), goal);
      largest = std::max(largest, std::abs(stability.full[0]));
    }
  }
  EXPECT_GT(largest, 2.7e17);
}

TEST(PendulumIndex, IsTheSameUnderATimeMap) {
  const loop::Isotropy symmetric = test::pendulum_isotropy(*pendulum());
  const loop::TimeMap pulse{2.0, {}};
  const loop::TimeMap lopsided{1.0, {0.12, -0.08, 0.0, 0.05}};
  for (const auto& [loop, reference] : pendulum_orbits()) {
    const double goal = reference.period <= 15 ? 1e-10 : 1e-9;
    for (const loop::TimeMap& map : {pulse, lopsided}) {
      const loop::Loop mapped = loop::with_time_map(loop, map, loop::next_cutoff(loop.cutoff));
      for (const loop::Isotropy& isotropy : {symmetric, loop::Isotropy{}}) {
        SCOPED_TRACE(testing::Message() << "T = " << reference.period << ", kappa " << map.kappa << ", isotropy "
                                        << loop::to_text(isotropy));
        const Stability stability = floquet(*pendulum(), mapped, isotropy);
        ASSERT_EQ(stability.full.size(), 1u);
        expect_value(stability.full[0], stability.full_error[0], full_of(reference.half), goal);
        EXPECT_EQ(stability.fundamental_order, map == pulse && !isotropy.empty() ? 2 : 1);
      }
    }
  }
}

TEST(PendulumIndex, FullIsTheSquareOfHalfLessTwo) {
  for (const auto& [loop, reference] : pendulum_orbits()) {
    const loop::Isotropy isotropy = test::pendulum_isotropy(*pendulum());
    const double half = floquet(*pendulum(), loop, isotropy).fundamental[0].real();
    const double full = floquet(*pendulum(), loop, {}).full[0].real();
    EXPECT_NEAR(full_of(half) / full, 1.0, 1e-11) << "T = " << reference.period;
  }
}

TEST(PendulumIndex, BoundCoversWhatTheLoopItselfHasWrong) {
  const loop::Isotropy isotropy = test::pendulum_isotropy(*pendulum());
  for (const auto& [loop, reference] : pendulum_orbits()) {
    for (const double share : {0.5, 0.7}) {
      const loop::Loop rough = loop::with_cutoff(loop, static_cast<int>(share * loop.cutoff));
      const Stability stability = floquet(*pendulum(), rough, isotropy);
      const double truth = full_of(reference.half);
      EXPECT_LE(std::abs(stability.full[0] - truth), stability.full_error[0])
          << "T = " << reference.period << ", cutoff " << rough.cutoff << ", relative error "
          << std::abs(stability.full[0] / truth - 1.0);
      EXPECT_LE(test::relative_error(stability), 0.1);
    }
  }
}

TEST(PendulumIndex, NewtonStepOfARoughLoopLeadsToTheOrbit) {
  const auto system = pendulum();
  const loop::Isotropy symmetric = test::pendulum_isotropy(*system);
  double largest = 0.0;
  for (const auto& [loop, reference] : pendulum_orbits()) {
    const loop::Loop rough = loop::with_cutoff(loop, loop.cutoff * 11 / 20);
    for (const loop::Isotropy& isotropy : {symmetric, loop::Isotropy{symmetric[0]}}) {
      const spectrum::FundamentalGroup group = spectrum::fundamental_group(*system, rough, isotropy);
      spectrum::VariationalStep stepper(*system);
      const spectrum::Chain chain = spectrum::make_chain(*system, stepper, rough, group, 8 * rough.cutoff);
      const auto index = [&](const spectrum::Chain& along) {
        const spectrum::TransverseFlow flow = spectrum::transverse_flow(*system, along, group);
        return spectrum::floquet_indices(system->structure(), flow, group.order).fundamental[0].real();
      };
      const spectrum::OrbitCorrection correction = spectrum::orbit_correction(chain, group, true);
      const double factor = 1e-7 / correction.states.cwiseAbs().maxCoeff();
      const double before = index(chain);
      const double after = before + (index(spectrum::corrected(*system, chain, correction, factor)) - before) / factor;
      EXPECT_LE(std::abs(after - reference.half), 0.02 * std::abs(before - reference.half) + 2e-11 * reference.half)
          << "T = " << reference.period << ", isotropy " << loop::to_text(isotropy);
      largest = std::max(largest, std::abs(before / reference.half - 1.0));
    }
  }
  EXPECT_GT(largest, 1e-8) << "nothing to correct";
}

TEST(PendulumIndex, FundamentalMapIsSymplectic) {
  const auto system = pendulum();
  for (const auto& [loop, reference] : pendulum_orbits()) {
    const spectrum::FundamentalGroup group =
        spectrum::fundamental_group(*system, loop, test::pendulum_isotropy(*system));
    spectrum::VariationalStep stepper(*system);
    const spectrum::Chain chain = spectrum::make_chain(*system, stepper, loop, group, 48);
    const spectrum::TransverseFlow flow = spectrum::transverse_flow(*system, chain, group);
    double area = 1.0;
    double volume = group.inverse.determinant();
    for (Eigen::Index m = 0; m < chain.segments(); ++m) {
      area *= spectrum::matrix_in<2>(flow.factors, m, 2).determinant();
      volume *= spectrum::matrix_in<4>(chain.transitions, m, 4).determinant();
    }
    EXPECT_NEAR(area, 1.0, 1e-10) << "T = " << reference.period;
    EXPECT_NEAR(volume, 1.0, 1e-10) << "T = " << reference.period;
  }
}

}  // namespace
}  // namespace floquet_pendulum_test
