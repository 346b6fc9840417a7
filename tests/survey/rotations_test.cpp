// The scene of the double pendulum turning over, against two free rods: far above, gravity is nothing beside the rates.
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace rotations_test {
namespace {

using namespace orbweaver;
constexpr double pi = std::numbers::pi;

/// The period at kinetic energy 1 of two free rods whose angle d = th2 - th1 turns once, in the sense `turn`, while th1
/// gains `gained`. With c = cos d and I = 3 + 2 c the angular momentum is J = I w1 + (1 + c) d', and the energy is
/// J^2/(2 I) + (2 - c^2) d'^2/(2 I).
double free_period(double gained, double turn) {
  const auto of = [&](double momentum) {
    constexpr int steps = 4000;  // the integrands are smooth and periodic
    double period = 0.0;
    double angle = 0.0;
    for (int n = 0; n < steps; ++n) {
      const double c = std::cos(2.0 * pi * (n + 0.5) / steps);
      const double inertia = 3.0 + 2.0 * c;
      const double rate = std::sqrt((2.0 * inertia - momentum * momentum) / (2.0 - c * c));
      const double time = 2.0 * pi / steps / rate;
      period += time;
      angle += (momentum - (1.0 + c) * turn * rate) / inertia * time;
    }
    return std::pair(period, angle);
  };
  double low = -std::sqrt(2.0) * 0.999999;  // d turns for J^2 < 2
  double high = -low;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (of(middle).second < gained ? low : high) = middle;
  }
  return of(low).first;
}

TEST(Rotations, BecomeThoseOfFreeRods) {
  const core::Communicator comm;
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/rotations.yaml");
  const survey::Summary summary = test::run(comm, scene, "rotations");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  // E T^2 of free rods; both rods as one: (2 + 1 +- 2 + ...) w^2/2 with T = 2 pi/w.
  const std::map<std::string, double> expected{
      {"Orbit n(0,1) T=0.821104 E=20", std::pow(free_period(0.0, 1.0), 2)},
      {"Orbit n(0,1) T=0.904046 E=20", std::pow(free_period(0.0, 1.0), 2)},
      {"Orbit n(1,0) T=0.99139 E=30", std::pow(free_period(2.0 * pi, -1.0), 2)},
      {"Orbit n(1,1) T=0.81141 E=30", 2.0 * pi * pi},
      {"Orbit n(1,1) T=1.81712 E=30", 10.0 * pi * pi},
  };
  const test::Atlas atlas(summary.atlas);
  std::size_t rotations = 0;
  for (const survey::FamilySummary& family : summary.families) {
    const auto found = expected.find(family.name);
    if (found == expected.end()) {
      EXPECT_NE(family.name.substr(0, 5), "Orbit") << family.name;
      continue;
    }
    ++rotations;
    SCOPED_TRACE(family.name);
    const std::vector<double> energy = atlas.column("energy", family.name);
    const std::vector<double> period = atlas.column("period", family.name);
    // Gravity shifts the kinetic energy by its mean over the orbit, which is within 3: E T^2 is off by as much of E.
    double nearest = 1.0;
    for (const double from : {energy.front(), energy.back()}) {
      if (std::abs(from - 1000.0) > 1e-6) continue;
      const double there = from == energy.front() ? period.front() : period.back();
      nearest = std::min(nearest, std::abs(1000.0 * there * there / found->second - 1.0));
    }
    EXPECT_LT(nearest, 3.0 / 1000.0);
  }
  EXPECT_EQ(rotations, expected.size());
  EXPECT_GT(summary.families.size(), expected.size()) << "the oscillations are in the archive too";
  EXPECT_GT(atlas.crossings().rows(), 20U);
}

}  // namespace
}  // namespace rotations_test
