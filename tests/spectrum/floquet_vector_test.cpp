#include "orbweaver/spectrum/floquet_vector.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/registry.hpp"
#include "pendulum_loops.hpp"
#include "point_systems.hpp"

namespace floquet_vector_test {
namespace {

using namespace orbweaver;

/// Closed form for lengths and gravity 1, masses 1 and m: w^2 = (1 + m)(1 +- sqrt(m/(1 + m))),
/// th2/th1 = -+ sqrt(1 + 1/m).
struct Modes {
  double slow;
  double fast;
  double ratio;  ///< th2/th1 of the slow one
};

Modes modes_of(double m) {
  const double root = std::sqrt(m / (1.0 + m));
  return {std::sqrt(1.0 / (1.0 + root)), std::sqrt((1.0 + m) * (1.0 + root)), std::sqrt(1.0 + 1.0 / m)};
}

/// `half`: from half the period and the loop's symmetry.
int needed(double m, double share, int most = 4096, bool half = false) {
  const auto system = systems::make_system("double_pendulum", {{"m2", m}});
  const Modes modes = modes_of(m);
  const test::PendulumMode slow{"slow", {0, 0, 0, 0}, modes.slow, modes.ratio};
  const loop::Loop loop = test::linear_loop(slow, 1e-4, 3);
  spectrum::FloquetVectorOptions options;
  const double pi = std::numbers::pi;
  // S^-1 of the half period's transition matrix: S = -1.
  options.angle = half ? std::remainder(modes.fast * slow.period() / 2.0 + pi, 2.0 * pi)
                       : std::remainder(modes.fast * slow.period(), 2.0 * pi);
  options.order = half ? 2 : 1;
  options.share = share;
  options.most = most;
  const loop::Isotropy isotropy =
      half ? loop::find_isotropy(system->structure(), loop, loop::symmetry_tolerance) : loop::Isotropy{};
  return spectrum::floquet_vector_cutoff(*system, loop, isotropy, options);
}

TEST(FloquetVector, NeedsTheRatioOfTheFrequencies) {
  for (const double m : {30.0, 1000.0, 30000.0}) {
    SCOPED_TRACE(m);
    const Modes modes = modes_of(m);
    // cos(fast t) has one harmonic; the angle is known modulo a turn, and v has one more than the series.
    const double ratio = modes.fast / modes.slow;
    EXPECT_NEAR(needed(m, 1e-3), ratio, 2.5);
  }
}

TEST(FloquetVector, IsContinuedByTheSymmetry) {
  for (const double m : {30.0, 1000.0}) {
    const Modes modes = modes_of(m);
    EXPECT_NEAR(needed(m, 1e-3, 4096, true), modes.fast / modes.slow, 2.5) << m;
  }
}

/// A free particle beside a clock: one of its two solutions of multiplier 1 grows with time.
class FreeParticle final : public test::PointSystem {
 public:
  FreeParticle() : PointSystem(driven()) {}
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector3d(z[1], 0.0, 1.0);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd&) const override {
    Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
    out(0, 1) = 1.0;
    return out;
  }

 private:
  static systems::Structure driven() {
    systems::Structure structure = test::structure_of(3);
    structure.angles = {2};
    structure.driven = true;
    return structure;
  }
};

TEST(FloquetVector, WhatDoesNotCloseIsNoSolution) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.5, 0.0, 0.0}, 2.0 * std::numbers::pi, 2);
  loop.winding[2] = 1.0;
  spectrum::FloquetVectorOptions options;
  options.order = 1;
  options.angle = 0.0;
  for (const int count : {1, 2}) {
    options.count = count;
    EXPECT_LE(spectrum::floquet_vector_cutoff(FreeParticle(), loop, {}, options), 2) << count;
  }
}

TEST(FloquetVector, SaysWhereTooManyAreNeeded) { EXPECT_GT(needed(1000.0, 1e-3, 50), 50); }

}  // namespace
}  // namespace floquet_vector_test
