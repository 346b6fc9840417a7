// Long segments against short ones that are ten times as many, and what they say of their own error.
#include "hermite_chain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "floquet_indices.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "spectrum/floquet_checks.hpp"
#include "spectrum/pendulum_loops.hpp"
#include "transverse_flow.hpp"

namespace hermite_chain_test {
namespace {

using namespace orbweaver;
using test::pendulum;

/// Orbits of the in-phase family, without symmetry, evenly in s and under the maps that their branch chooses.
const std::vector<loop::Loop>& loops() {
  static const std::vector<loop::Loop> found = [] {
    std::vector<loop::Loop> all;
    const test::PendulumMode mode = test::in_phase();
    for (const bool mapped : {false, true}) {
      continuation::Options options;
      options.fit_time_map = mapped;
      options.period_limit = 16.0;
      for (const continuation::Orbit& orbit : test::trace_of(mode, options).orbits)
        if (orbit.loop.period > 9.5) all.push_back(orbit.loop);
    }
    return all;
  }();
  return found;
}

spectrum::FundamentalGroup whole(const loop::Loop& loop) {
  return spectrum::fundamental_group(*pendulum(), loop, {});
}

double index_of(const spectrum::Chain& chain, const spectrum::FundamentalGroup& group) {
  const spectrum::TransverseFlow flow = spectrum::transverse_flow(*pendulum(), chain, group);
  return spectrum::floquet_indices(pendulum()->structure(), flow, group.order).fundamental[0].real();
}

double fine_index(const loop::Loop& loop, const spectrum::FundamentalGroup& group) {
  spectrum::VariationalStep stepper(*pendulum());
  return index_of(spectrum::make_chain(*pendulum(), stepper, loop, group, 10 * loop.cutoff), group);
}

TEST(HermiteChain, ErrorsFallAsTheSixteenthPowerAndAreWithinTheirEstimates) {
  ASSERT_GE(loops().size(), 6u);
  for (const loop::Loop& loop : loops()) {
    SCOPED_TRACE(testing::Message() << "T = " << loop.period << ", kappa " << loop.time_map.kappa);
    const spectrum::FundamentalGroup group = whole(loop);
    const double truth = fine_index(loop, group);
    const auto error_at = [&](int segments) {
      const spectrum::HermiteChain chain(*pendulum(), loop, group, segments);
      const double index = index_of(chain.chain(), group);
      spectrum::Chain wrong = chain.chain();  // each factor changed by what its estimate says
      double estimate = 0.0;
      for (Eigen::Index m = 0; m < wrong.segments(); ++m) {
        wrong.transitions = chain.chain().transitions;
        wrong.transitions.col(m) += 1e3 * wrong.truncations.col(m);
        estimate += 1e-3 * std::abs(index_of(wrong, group) - index);
      }
      EXPECT_LE(std::abs(index - truth), estimate + 3e-12 * (2.0 + std::abs(truth))) << segments << " segments";
      return std::abs(index - truth) / (2.0 + std::abs(truth));
    };
    const int least = spectrum::allowed_segments(0.75 * loop.cutoff, 4);
    const double coarse = error_at(least);
    const double fine = error_at(3 * least / 2);
    EXPECT_LE(fine, std::max(std::pow(1.5, -12.0) * coarse, 3e-12));
    EXPECT_LE(coarse, 1e-9);
  }
}

TEST(HermiteChain, ServesOrbitsAtTheirBoundsAndCountsTurnsAlike) {
  for (const loop::Loop& loop : loops()) {
    SCOPED_TRACE(testing::Message() << "T = " << loop.period << ", kappa " << loop.time_map.kappa);
    const double truth = fine_index(loop, whole(loop));
    const spectrum::Stability here = spectrum::floquet(*pendulum(), loop, {});
    test::expect_value(here.full[0], here.full_error[0], truth, 1e-10);
    // With a quarter of the harmonics cut off it is no loop for long segments; turns are those of any.
    const loop::Loop rough = loop::with_cutoff(loop, loop.cutoff * 3 / 4);
    EXPECT_NEAR(here.turns, spectrum::floquet(*pendulum(), rough, {}).turns, 1e-6);
  }
}

}  // namespace
}  // namespace hermite_chain_test
