#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "correction.hpp"
#include "orbweaver/core/error.hpp"
#include "setting.hpp"
#include "spring_scene.hpp"

namespace closed_forms_test {
namespace {

using namespace orbweaver;

struct Bounce : ::testing::Test {
  core::Communicator comm;
  cost::Options options{"Bounce", {}, true};
  cost::Setting setting{comm, test::spring_scene(), options};
  [[nodiscard]] const cost::Probe& probe() const { return setting.probes().front(); }
};

TEST_F(Bounce, ProbesLieInTheMiddleOfTheFamilyAndNearItsEnd) {
  EXPECT_EQ(setting.family(), "Bounce");
  ASSERT_EQ(setting.probes().size(), 2U);
  const double length = setting.orbits().back().arclength;
  double step = 0.0;
  for (std::size_t n = 1; n < setting.orbits().size(); ++n)
    step = std::max(step, setting.orbits()[n].arclength - setting.orbits()[n - 1].arclength);
  EXPECT_NEAR(setting.probes()[0].orbit.arclength, 0.5 * length, step);
  EXPECT_NEAR(setting.probes()[1].orbit.arclength, 0.9 * length, step);
}

TEST_F(Bounce, ALinearOscillationIsItsOwnTrueOrbit) {
  loop::Loop exact = probe().orbit.loop;
  for (int k = 2; k <= exact.cutoff; ++k)
    for (int i = 0; i < exact.dimension; ++i) exact.cosine(k, i) = exact.sine(k, i) = 0.0;
  exact.period = 2.0 * std::numbers::pi / std::sqrt(3.0) / setting.system()->scales().time;
  EXPECT_LT(setting.truth_of(probe()).error_of(exact), 1e-13);
}

TEST_F(Bounce, AThirdHarmonicIsFoundAtItsSize) {
  loop::Loop bent = probe().orbit.loop;
  bent.cosine(3, 1) += 1e-5;
  EXPECT_NEAR(setting.truth_of(probe()).error_of(bent), 1e-5, 1e-6);
}

TEST_F(Bounce, OtherTimesAndOtherPlacesOfTheFamilyAreNoErrors) {
  const cost::TrueOrbit& truth = setting.truth_of(probe());
  EXPECT_LT(truth.error_of(loop::moved(probe().orbit.loop, probe().tangent, 1e-3)), 1e-12);
  EXPECT_LT(truth.error_of(loop::time_shifted(probe().orbit.loop, 1e-7)), 1e-12);
  EXPECT_GT(truth.error_of(loop::moved(probe().orbit.loop, probe().tangent, 1e-3)), 0.0);
}

TEST_F(Bounce, APushIsAsLargeAsAPredictionsErrorAndCorrectionsTakeItBack) {
  const cost::Directed pushed = cost::pushed_off(setting, probe());
  const cost::TrueOrbit& truth = setting.truth_of(probe());
  const double allowed = setting.branch_options().prediction_error;
  EXPECT_LT(truth.error_of(pushed.loop), 1.01 * allowed);
  EXPECT_GT(truth.error_of(pushed.loop), 0.01 * allowed);
  const cost::Correction correction(setting, pushed, setting.isotropy());
  EXPECT_LT(truth.error_of(correction.by(corrector::Method::newton_krylov, 1e-13).loop), 1e-12);
  const auto collocated =
      cost::by_collocation(setting, pushed, probe().orbit.loop, cost::cells_for(setting, pushed.loop.cutoff), 1e-13);
  EXPECT_TRUE(collocated.converged) << collocated.reason;
  EXPECT_LT(truth.error_of(collocated.loop), 1e-12);
}

TEST_F(Bounce, ShootingMeetsTheTrueOrbit) {
  const cost::TrueOrbit& truth = setting.truth_of(probe());
  for (const int segments : {1, 0})
    EXPECT_LT(truth.error_of(refine::shoot(truth.guess(), truth.held(), segments)), 1e-12) << segments;
  EXPECT_THROW(static_cast<void>(refine::shoot(truth.guess(), truth.held(), 1000)), core::MisuseError);
}

TEST(Setting, NamesTheFamiliesToChooseFrom) {
  const core::Communicator comm;
  try {
    const cost::Setting setting(comm, test::spring_scene(), {"Bonce", {}, true});
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("Cup, Cap, Bounce, got `Bonce`"));
  }
}

}  // namespace
}  // namespace closed_forms_test
