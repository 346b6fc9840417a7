// What is measured on an orbit does not depend on its time map.
#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "support/best_pulse.hpp"

namespace orbweaver::continuation::mapped_test {
namespace {

TEST(MappedOrbit, HasTheSameEnergyActionAndArclength) {
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  for (const test::PendulumMode& mode : test::pendulum_modes()) {
    const auto& orbits = test::even_family_to_twelve(mode).orbits;
    const loop::Loop& a = orbits.at(orbits.size() / 2).loop;
    const loop::Loop& b = orbits.at(orbits.size() / 2 + 1).loop;
    const loop::TimeMap general = loop::fit_general(b, isotropy, 1e-12).map;
    ASSERT_TRUE(loop::is_invariant(general, isotropy));
    for (const loop::TimeMap& map : {loop::TimeMap{1.3, {}}, general}) {
      const loop::Loop mapped_a = loop::with_time_map(a, map, 400);
      const loop::Loop mapped_b = loop::with_time_map(b, map, 400);
      EXPECT_NEAR(action_of(*test::pendulum(), mapped_b), action_of(*test::pendulum(), b), 1e-12) << mode.name;
      EXPECT_NEAR(energy_of(*test::pendulum(), mapped_b), energy_of(*test::pendulum(), b), 1e-12) << mode.name;
      EXPECT_NEAR(arclength_between(mapped_a, mapped_b), arclength_between(a, b), 1e-12) << mode.name;
      EXPECT_NEAR(arclength_between(mapped_a, b), arclength_between(a, b), 1e-12) << mode.name;
      EXPECT_EQ(loop::to_text(loop::find_isotropy(test::pendulum()->structure(), mapped_b, 1e-9)), "S@1/2 R@0");
    }
  }
}

// Fewer harmonics serve: the map that is fitted, against none and against the best pulse.
TEST(MappedOrbit, NeedsFewerHarmonics) {
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  const loop::Loop& last = test::even_family_to_twelve(test::out_phase()).last().loop;
  const int even = loop::harmonics_above(last, 1e-12);
  const int pulse = test::best_pulse(last, 1e-12).harmonics;
  const int general = loop::fit_general(last, isotropy, 1e-12).harmonics;
  EXPECT_LT(pulse, 0.4 * even);
  EXPECT_LT(general, 0.9 * pulse);
}

}  // namespace
}  // namespace orbweaver::continuation::mapped_test
