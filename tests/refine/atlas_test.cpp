#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/refine/stored_family.hpp"
#include "survey/atlas.hpp"

namespace atlas_test {
namespace {

using namespace orbweaver;
using numerics::Extended;
using refine::HeldValue;
using refine::Number;
using refine::RefinedOrbit;
using refine::StoredFamily;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Quantity = HeldValue::Quantity;

/// The four families and their branches to T = 11, surveyed once.
class RefineAtlas : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const core::Communicator comm;
    const scene::Scene scene = test::quick_scene({"survey.depth=1", "survey.subharmonics=4", "limits.period=11"});
    atlas = std::make_unique<test::Atlas>(test::run(comm, scene, "pendulum").atlas);
  }
  static void TearDownTestSuite() { atlas.reset(); }
  static const test::Atlas& pendulum() { return *atlas; }

 private:
  static inline std::unique_ptr<test::Atlas> atlas;
};

std::vector<Number> numbers_of(const RefinedOrbit& orbit) {
  std::vector<Number> numbers = orbit.state;
  numbers.push_back(orbit.period);
  numbers.push_back(*orbit.energy);
  numbers.push_back(*orbit.index);
  numbers.push_back(*orbit.fundamental_index);
  return numbers;
}

/// The same with many more digits is within the bounds of the first, and those are what was asked for.
void expect_bounds_hold(const RefinedOrbit& few, const RefinedOrbit& many, const std::string& what) {
  const numerics::WorkingDigits working(many.working_digits);
  const std::vector<Number> a = numbers_of(few);
  const std::vector<Number> b = numbers_of(many);
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_LE(abs(Extended(a[n].value - b[n].value)), a[n].error + b[n].error) << what << ' ' << n;
    EXPECT_LE(numerics::log10_abs(a[n].error), std::max(0.0, numerics::log10_abs(b[n].value)) - few.digits)
        << what << ' ' << n;
  }
}

/// Once around by an integrator that has nothing in common with it.
void expect_closed(const systems::System& system, const RefinedOrbit& orbit, const std::string& what) {
  std::vector<double> start;
  for (const Number& x : orbit.state) start.push_back(static_cast<double>(x.value));
  const std::vector<double> end = certificate::integrate(system, start, static_cast<double>(orbit.period.value), 1e-14);
  const double growth = std::max(1.0, std::abs(static_cast<double>(orbit.index->value)));
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_NEAR(end[i], start[i], 1e-11 * growth) << what;
}

TEST_F(RefineAtlas, GivesOrbitsByPeriodEnergyAndStep) {
  const StoredFamily family = StoredFamily::named(pendulum(), "In-Phase");
  const HeldValue by_period{Quantity::period, "9"};
  const StoredFamily::Place place = family.with(by_period, std::nullopt);
  const RefinedOrbit orbit = refine::refine_orbit(place.guess, by_period, 20);
  expect_closed(*place.guess.system, orbit, "T = 9");
  expect_bounds_hold(orbit, refine::refine_orbit(place.guess, by_period, 45), "T = 9");
  // z(t + T/2) = -z(t): M(T) is the square of the fundamental map.
  ASSERT_EQ(orbit.order, 2);
  const numerics::WorkingDigits working(25);
  const Extended square = orbit.fundamental_index->value * orbit.fundamental_index->value;
  EXPECT_LT(numerics::log10_abs(orbit.index->value - (square - 2)), -18.0);
  EXPECT_LT(numerics::log10_abs(2 * orbit.multipliers[0].value - orbit.index->value), -18.0);
  EXPECT_TRUE(orbit.unit_circle);
  // From its energy the same orbit, to the digits that the energy has.
  const HeldValue by_energy{Quantity::energy, numerics::decimal_text(orbit.energy->value, 25)};
  const RefinedOrbit same = refine::refine_orbit(family.with(by_energy, std::nullopt).guess, by_energy, 18);
  EXPECT_LT(numerics::log10_abs(same.period.value - 9), -17.0);
  // A stored orbit: its own numbers to the accuracy that it has.
  const auto states = pendulum().orbits().reals("state");
  const auto first = static_cast<std::size_t>(pendulum().families().integers("first_orbit")[pendulum().row_of("IB")]);
  const auto row = first + static_cast<std::size_t>(3 - pendulum().orbits().integers("step")[first]);
  const StoredFamily branch = StoredFamily::named(pendulum(), "IB");
  const StoredFamily::Place stored = branch.at_step(3);
  const HeldValue held{Quantity::period, branch.stored(Quantity::period, 3)};
  const RefinedOrbit fine = refine::refine_orbit(stored.guess, held, 20);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(static_cast<double>(fine.state[i].value), states[4 * row + i], 1e-9);
  EXPECT_NEAR(static_cast<double>(fine.index->value), pendulum().orbits().reals("stability")[row], 1e-6);
  ASSERT_TRUE(fine.largest.has_value());
  expect_closed(*stored.guess.system, fine, "IB");
}

TEST_F(RefineAtlas, SaysWhatItDoesNotHave) {
  EXPECT_THAT([] { static_cast<void>(StoredFamily::named(pendulum(), "Inn-Phase")); },
              ThrowsMessage<core::InputError>(HasSubstr("no family `Inn-Phase`")));
  const StoredFamily family = StoredFamily::named(pendulum(), "In-Phase");
  EXPECT_THAT(
      [&] {
        static_cast<void>(family.with({Quantity::period, "90"}, std::nullopt));
      },
      ThrowsMessage<core::InputError>(HasSubstr("no orbit with T = 90: it reaches from 8.2")));
  EXPECT_THAT([&] { static_cast<void>(family.at_step(1000)); },
              ThrowsMessage<core::InputError>(HasSubstr("no step 1000")));
  EXPECT_THAT([] { static_cast<void>(refine::stored_crossing(pendulum(), 1000)); },
              ThrowsMessage<core::InputError>(HasSubstr("no row 1000")));
  // OB turns in its period: two orbits with one T.
  const StoredFamily turning = StoredFamily::named(pendulum(), "OB");
  const HeldValue twice{Quantity::period, "5.84"};
  EXPECT_THAT([&] { static_cast<void>(turning.with(twice, std::nullopt)); },
              ThrowsMessage<core::InputError>(HasSubstr("2 orbits with T = 5.84")));
  EXPECT_NO_THROW(static_cast<void>(turning.with(twice, 1)));
}

// All crossings of the first families, the first one of each branch, and folds: as stored, to its accuracy; within the
// bounds, at more digits; and what each claims.
TEST_F(RefineAtlas, FindsCrossings) {
  const auto& kinds = pendulum().crossing_kinds();
  ASSERT_GE(kinds.size(), 14U);
  ASSERT_TRUE(std::find(kinds.begin(), kinds.end(), archive::CrossingKind::fold_period) != kinds.end());
  std::set<std::int64_t> seen;
  for (std::size_t row = 0; row < kinds.size(); ++row) {
    const std::int64_t family = pendulum().crossings().integers("family")[row];
    const bool is_on_branch = pendulum().families().integers("parent")[static_cast<std::size_t>(family)] >= 0;
    const bool is_first = seen.insert(family).second;
    if (is_on_branch && !is_first && !archive::is_fold(kinds[row])) continue;
    const std::string what = "row " + std::to_string(row);
    const refine::StoredCrossing crossing = refine::stored_crossing(pendulum(), row);
    const RefinedOrbit few = refine::refine_crossing(crossing.place.guess, crossing.condition, 12);
    expect_bounds_hold(few, refine::refine_crossing(crossing.place.guess, crossing.condition, 20), what);
    EXPECT_NEAR(static_cast<double>(few.period.value), crossing.period, 1e-8) << what;
    EXPECT_NEAR(static_cast<double>(few.energy->value), pendulum().crossings().reals("energy")[row], 1e-8) << what;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(static_cast<double>(few.state[i].value), pendulum().crossings().reals("state")[4 * row + i], 1e-7)
          << what;
    if (archive::has_sector(crossing.condition.kind)) {
      const numerics::WorkingDigits working(30);
      const Extended angle = 2 * acos(Extended(-1)) * crossing.condition.sector_j / crossing.condition.sector_q;
      EXPECT_LT(numerics::log10_abs(few.fundamental_index->value - 2 * cos(angle)), -20.0) << what;
    }
    expect_closed(*crossing.place.guess.system, few, what);
  }
}

}  // namespace
}  // namespace atlas_test
