// Orbits on the curve through another family's, by the numbers that tell best where they lie.
#include "orbweaver/survey/atlas/invariant_curve.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace invariant_curve_test {
namespace {

using namespace orbweaver::survey;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of a family of one period along which a parameter turns at +-0.2, as about an isola.
Invariants orbit_at(double angle) {
  Invariants x;
  x.values = {6.25, 0.2 * std::cos(angle), unknown, unknown, std::asinh(std::exp(2.0 * std::sin(angle)))};
  x.scale = {6.25, 0.2, unknown, unknown, 1.0};
  for (std::size_t i = 0; i < x.floor.size(); ++i) x.floor[i] = 1e-9 * x.scale[i];
  return x;
}

InvariantCurve curve_with(int orbits) {
  std::vector<Invariants> points;
  for (int n = 0; n <= orbits; ++n) points.push_back(orbit_at(-2.0 + 4.0 * n / orbits));
  return InvariantCurve(points);
}

/// Beside a fold the parameter says nothing of where an orbit lies, the stability does.
TEST(InvariantCurve, GoesThroughAFoldOfItsOnlyLevel) {
  for (const int orbits : {8, 16, 32}) {
    const InvariantCurve curve = curve_with(orbits);
    for (double angle = -1.2; angle <= 1.2; angle += 0.0371) {
      SCOPED_TRACE(::testing::Message() << orbits << " orbits, at " << angle);
      EXPECT_TRUE(curve.fit_anywhere(orbit_at(angle)).fits());
    }
  }
}

/// What lies off it does so where the polynomials tell.
TEST(InvariantCurve, TellsWhatIsOffIt) {
  const InvariantCurve curve = curve_with(32);
  for (double angle = -1.2; angle <= 1.2; angle += 0.0371) {
    SCOPED_TRACE(angle);
    Invariants off = orbit_at(angle);
    off.values[1] -= 0.01;
    EXPECT_FALSE(curve.fit_anywhere(off).fits());
  }
}

}  // namespace
}  // namespace invariant_curve_test
