// Folds of a period that turns twice: they do not hang on which orbits lie around them.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/surveyed_well.hpp"

namespace folds_test {

using namespace orbweaver;

/// x'' = -x + a x^3 - b x^5 + c x^7. To first order in the coefficients T/(2 pi) = 1 + 3 a u/8 - 5 b u^2/16 + 35 c
/// u^3/128 with u the square of the amplitude.
class Spring {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("spring", "a mass on a spring that softens and hardens", {"x", "v"}, {"a", "b", "c"});
  }

  static systems::Structure structure(const systems::Bound&) {
    const Eigen::Matrix2d back = Eigen::Vector2d(1, -1).asDiagonal();
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    structure.reversors = {{"R", back}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _a(bound["a"]), _b(bound["b"]), _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], xx = x * x;
      f[0] = z[1];
      f[1] = x * (xx * (_a - xx * (_b - xx * _c)) - 1.0);
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S xx = z[0] * z[0];
      return z[1] * z[1] * 0.5 + xx * (S(0.5) - xx * (S(0.25) * _a - xx * (S(1.0 / 6.0) * _b - xx * _c * 0.125)));
    }

    template <class S>
    S action_density(const S* z) const {
      return z[1] * z[1];
    }

   private:
    P _a, _b, _c;
  };
};

namespace {

/// The energies at which T turns, in their order along the family.
std::vector<double> folds(const std::string& start, const std::string& step) {
  const auto spring =
      systems::recorded<Spring>(systems::bound_to(Spring::info(), {{"a", 0.0384}, {"b", 0.03904}, {"c", 0.01219}}, {}));
  const test::Atlas atlas =
      test::survey_of(spring, {"starts={fixed_points: {grid: [[0], [0]]}}", "limits.energy=[0, 1.2]", "limits.period=8",
                               "continuation.start=" + start, "continuation.step=" + step});
  std::vector<double> energies;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().texts("kind")[row] == "fold-period")
      energies.push_back(atlas.crossings().reals("energy")[row]);
  return energies;
}

// Of three orbits the one in the middle had the longest period, and the two folds lay on one side of it: one was stored
// in the other's place, and to half the digits.
TEST(Folds, OfThePeriodAreTheSameWhateverTheSteps) {
  const std::vector<double> fine = folds("0.01", "0.02");
  ASSERT_EQ(fine.size(), 2U);
  for (const std::string start : {"0.01", "0.013", "0.017", "0.022"})
    for (const std::string step : {"0.1", "0.2", "0.3", "0.4"}) {
      SCOPED_TRACE(testing::Message() << start << ", " << step);
      const std::vector<double> found = folds(start, step);
      ASSERT_EQ(found.size(), 2U);
      EXPECT_NEAR(found[0], fine[0], 1e-9);
      EXPECT_NEAR(found[1], fine[1], 1e-9);
    }
}

}  // namespace
}  // namespace folds_test
