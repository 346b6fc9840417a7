#include "orbweaver/bifurcation/meetings.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace meetings_test {
namespace {

using namespace orbweaver;
using bifurcation::meetings_between;
using bifurcation::StabilityAt;
using spectrum::Stability;

constexpr double mean_angle = 1.2;

/// A pair of this angle in the plane of coordinates 2 n and 2 n + 1, or in one between those of n = 0 and 1.
void add_pair(double angle, double mixed, Stability& out) {
  spectrum::Rotation rotation{angle, {}};
  rotation.plane.setZero(8, 2);
  for (const Eigen::Index column : {0, 1}) {
    rotation.plane(column, column) = std::cos(mixed);
    rotation.plane(column + 2, column) = std::sin(mixed);
  }
  out.fundamental.emplace_back(2.0 * std::cos(angle));
  out.fundamental_error.push_back(1e-15);
  out.rotations.push_back(rotation);
}

/// Two pairs whose angles are equal at s = 0: `off` > 0 leaves the circle for |s| < off, `gap` > 0 repels.
struct Family {
  double off = 0.0;
  double gap = 0.0;
  int asked = 0;

  Stability at(double s) {
    ++asked;
    Stability out;
    const double square = s * s - off * off + gap * gap;
    if (square < 0.0) {
      const std::complex<double> angle(mean_angle, std::sqrt(-square));
      out.fundamental = {2.0 * std::cos(angle), std::conj(2.0 * std::cos(angle))};
      out.fundamental_error = {1e-15, 1e-15};
      return out;
    }
    const double mixed = 0.5 * std::atan2(gap, s);
    add_pair(mean_angle + std::sqrt(square), mixed, out);
    add_pair(mean_angle - std::sqrt(square), mixed + 0.5 * std::numbers::pi, out);
    return out;
  }
  std::vector<StabilityAt> between(double from, double to) {
    const StabilityAt first{from, at(from)};
    const StabilityAt last{to, at(to)};
    asked = 0;
    return meetings_between(first, last, [this](double s) { return at(s); });
  }
};

TEST(Meetings, PairsThatLeaveTheCircleWithinAStepAreFound) {
  for (const double off : {1e-1, 1e-3, 1e-6}) {
    SCOPED_TRACE(off);
    Family family{off};
    const std::vector<StabilityAt> found = family.between(-0.37, 0.29);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LT(std::abs(found[0].position), off);
    EXPECT_NE(found[0].stability.fundamental[0].imag(), 0.0);
    EXPECT_LE(family.asked, 16);
  }
}

TEST(Meetings, PairsThatPassOneAnotherDoNotMeet) {
  Family family;
  EXPECT_TRUE(family.between(-0.37, 0.29).empty());
  EXPECT_LE(family.asked, 4);
  EXPECT_TRUE(family.between(0.1, 0.29).empty());
  EXPECT_EQ(family.asked, 0) << "nothing has changed order";
}

TEST(Meetings, PairsThatRepelDoNotMeet) {
  for (const double gap : {1e-2, 1e-4}) {
    SCOPED_TRACE(gap);
    Family family{0.0, gap};
    EXPECT_TRUE(family.between(-0.37, 0.29).empty());
    EXPECT_LE(family.asked, 16);
  }
}

TEST(Meetings, NothingIsAskedOfOnePair) {
  Stability one;
  add_pair(1.0, 0.0, one);
  int asked = 0;
  const auto between = [&](double) -> std::optional<Stability> {
    ++asked;
    return one;
  };
  EXPECT_TRUE(meetings_between({0.0, one}, {1.0, {}}, between).empty());
  EXPECT_EQ(asked, 0);
}

}  // namespace
}  // namespace meetings_test
