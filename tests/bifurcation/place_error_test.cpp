// How far computed zeros may lie from the true ones, of functions with a bound of their error.
#include "orbweaver/bifurcation/place_error.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace place_error_test {
namespace {

using namespace orbweaver::bifurcation;

constexpr double bound = 1e-12;
constexpr double least = 1e-11;

/// An enclosure of a zero of `value`, computed at `place`, and how often the function was asked.
struct Asked {
  Enclosure enclosure;
  int times = 0;
};
template <class Function>
Asked asked(const Function& value, double place, double from = -0.3, double to = 0.2) {
  Asked found;
  const BoundedFunction function = [&](double position) {
    ++found.times;
    return Reading{value(position), bound};
  };
  found.enclosure = enclosure_of_zero(function, {}, place, from, to, least);
  return found;
}

/// |slope s^power| is the bound at (bound/slope)^(1/power).
TEST(PlaceError, IsWhereAPowerOfTheDistanceIsTheBound) {
  for (const double power : {1.0, 3.0, 5.0})
    for (const double slope : {0.02, 1.0, 50.0}) {
      SCOPED_TRACE(::testing::Message() << slope << " s^" << power);
      const double exact = std::fmax(std::pow(bound / slope, 1.0 / power), 0.5 * least);
      const Asked found = asked([&](double s) { return slope * std::copysign(std::pow(std::abs(s), power), s); }, 0.0);
      EXPECT_TRUE(found.enclosure.is_told);
      for (const double side : {found.enclosure.before, found.enclosure.behind}) {
        EXPECT_GE(side, exact * (1.0 - 1e-9));
        EXPECT_LE(side, 2.0 * exact * (1.0 + 1e-9));
      }
      EXPECT_LE(found.times, power > 1.0 ? 30 : 12);
    }
}

/// Wherever in the flat part a location has come to rest, and on which side, the zero is covered.
TEST(PlaceError, CoversAZeroFromAnyPlaceWhereTheFunctionIsBelowItsBound) {
  for (const double power : {1.0, 3.0, 5.0}) {
    const double flat = std::pow(bound, 1.0 / power);
    for (const double share : {-1.0, -0.7, 0.1, 0.5, 1.0}) {
      SCOPED_TRACE(::testing::Message() << "s^" << power << " at " << share);
      const double place = share * flat;
      const Asked found = asked([&](double s) { return std::copysign(std::pow(std::abs(s), power), s); }, place);
      EXPECT_GE(place + found.enclosure.behind, 0.0);
      EXPECT_LE(place - found.enclosure.before, 0.0);
      EXPECT_LE(std::fmax(found.enclosure.before, found.enclosure.behind), std::fmax(4.0 * flat, 2.0 * least));
    }
  }
}

/// Values that the location has had already are not asked for again, and one with the wrong sign tells nothing.
TEST(PlaceError, TakesWhatIsKnown) {
  int times = 0;
  const BoundedFunction function = [&](double s) {
    ++times;
    return Reading{s * s * s, bound};
  };
  const double flat = std::cbrt(bound);
  const std::vector<double> known{-1.5 * flat, -0.9 * flat, 0.9 * flat, 1.5 * flat};
  const Enclosure found = enclosure_of_zero(function, known, 0.0, -1.0, 1.0, least);
  EXPECT_DOUBLE_EQ(found.before, 1.5 * flat);
  EXPECT_DOUBLE_EQ(found.behind, 1.5 * flat);
  EXPECT_LE(times, 10);  // of these places only
  const BoundedFunction jumping = [&](double s) { return Reading{s < -0.2 || s > 1e-3 ? s : -s, 0.3 * std::abs(s)}; };
  const double before = enclosure_of_zero(jumping, {}, 0.0, -1.0, 1.0, least).before;
  EXPECT_GE(before, 0.2);
  EXPECT_LT(before, 1.0);
}

/// A minimum that touches zero has the same sign on both sides; what does not exceed its bound anywhere reaches up to
/// the ends.
TEST(PlaceError, OfATouchAndOfNothingThatIsTold) {
  const Asked touch = asked([](double s) { return s * s; }, 0.0);
  EXPECT_TRUE(touch.enclosure.is_told);
  EXPECT_GE(touch.enclosure.before, 1e-6 * (1.0 - 1e-9));
  EXPECT_LE(touch.enclosure.before, 2e-6);
  const Asked nothing = asked([](double s) { return 1e-13 * s; }, 0.0);
  EXPECT_FALSE(nothing.enclosure.is_told);
  EXPECT_DOUBLE_EQ(nothing.enclosure.before, 0.3);
  EXPECT_DOUBLE_EQ(nothing.enclosure.behind, 0.2);
}

}  // namespace
}  // namespace place_error_test
