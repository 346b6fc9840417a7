// How far rounding may move an orbit: by little, but where the equations are singular.
#include "orbweaver/continuation/left_open.hpp"

#include <gtest/gtest.h>

#include "families.hpp"

namespace left_open_test {
namespace {

using namespace orbweaver;
using continuation::left_open_by_rounding;

// At T = 10.41677328 a family without the reversor leaves In-Phase.
TEST(LeftOpen, IsMuchWhereAnotherFamilyWithTheIsotropyCrosses) {
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  ASSERT_EQ(isotropy.size(), 2U);
  const loop::Isotropy half_turn{isotropy.front().reversing ? isotropy.back() : isotropy.front()};
  const loop::Loop regular = test::orbit_at(test::family_to_twelve(test::in_phase()), 9.0).loop;
  const loop::Loop crossing = test::orbit_at(test::family_to_twelve(test::in_phase()), 10.41677328).loop;
  for (const loop::Loop* orbit : {&regular, &crossing}) {
    EXPECT_GT(left_open_by_rounding(*test::pendulum(), *orbit, isotropy).across, 1e-15);
    EXPECT_LT(left_open_by_rounding(*test::pendulum(), *orbit, isotropy).across, 1e-10);
  }
  EXPECT_LT(left_open_by_rounding(*test::pendulum(), regular, half_turn).across, 1e-10);
  EXPECT_GT(left_open_by_rounding(*test::pendulum(), crossing, half_turn).across, 1e-5);
}

// Of more unknowns than are factored: GMRES solves for it.
TEST(LeftOpen, IsKnownOfOrbitsWithManyUnknowns) {
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  const loop::Loop orbit = test::orbit_at(test::family_to_twelve(test::in_phase()), 9.0).loop;
  const loop::Loop large = loop::with_cutoff(orbit, 2047);
  const double across = left_open_by_rounding(*test::pendulum(), orbit, isotropy).across;
  const double of_large = left_open_by_rounding(*test::pendulum(), large, isotropy).across;
  EXPECT_GT(of_large, across);
  EXPECT_LT(of_large, 1e3 * across);
}

}  // namespace
}  // namespace left_open_test
