#include "twin_order.hpp"

#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"

namespace orbweaver::bifurcation::twin_order_test {
namespace {

TEST(TwinOrder, NumbersAsNearAsRoundingDoNotDecide) {
  const std::vector<double> one{1.0, 2.0, 0.0};
  EXPECT_FALSE(stands_before(one, one, 1e-6));
  for (const double rounding : {-3e-7, 0.0, 3e-7}) {
    const std::vector<double> other{1.0 + rounding, 1.9, 5.0};
    EXPECT_TRUE(stands_before(one, other, 1e-6)) << rounding;
    EXPECT_FALSE(stands_before(other, one, 1e-6)) << rounding;
  }
  EXPECT_TRUE(stands_before({1.00001, 1.0}, {1.0, 7.0}, 1e-6));
  // Relative to the larger, whatever the units.
  EXPECT_TRUE(stands_before({2e-12, 0.0}, {1e-12, 0.0}, 1e-6));
}

TEST(TwinOrder, OrbitsGoByPeriodThenEnergyThenSpeed) {
  const auto system = systems::make_system("henon_heiles");
  const auto orbit = [](double period, double x, double turning) {
    FoundOrbit out;
    out.loop = loop::constant_loop(std::vector<double>{x, 0.0, 0.0, 0.0}, period, 4);
    out.loop.sine(2, 1) = turning;
    return out;
  };
  std::vector<FoundOrbit> found{orbit(6.0, 0.1, 0.0), orbit(6.0, 0.2, 0.0), orbit(6.0 + 1e-10, 0.1, 0.01),
                                orbit(6.1, 0.0, 0.0)};
  put_in_order(*system, found);
  EXPECT_EQ(found[0].loop.period, 6.1);
  EXPECT_EQ(found[1].loop.cosine(0, 0), 0.2);
  EXPECT_GT(found[2].loop.period, 6.0);
  EXPECT_EQ(found[3].loop.sine(2, 1), 0.0);
}

TEST(TwinOrder, SymmetricInstantsAreOneWhereverALoopStarts) {
  const auto system = systems::make_system("henon_heiles");
  loop::Loop orbit = loop::constant_loop(std::vector<double>{0.1, 0.2, 0.0, 0.0}, 6.0, 4);
  orbit.cosine(1, 0) = 0.3;
  orbit.sine(1, 2) = -0.2;
  const std::vector<double> here = at_symmetric_instants(*system, orbit);
  const std::vector<double> later = at_symmetric_instants(*system, loop::time_shifted(orbit, 0.5));
  ASSERT_EQ(here.size(), 4u);
  for (std::size_t n = 0; n < here.size(); ++n) EXPECT_NEAR(later[n], here[n], 1e-14);
  EXPECT_GT(here[0], here[1]);
}

}  // namespace
}  // namespace orbweaver::bifurcation::twin_order_test
