// Lur'e's feedback system, x''' + alpha x'' + x' + x - x^2 = 0: on its doubled family one multiplier passes -1, meets
// the other outside the unit circle, and both come back beyond 1, all within a step.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"

namespace lure_test {

using namespace orbweaver;

class Lure {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    constexpr double any = std::numeric_limits<double>::infinity();
    systems::ModelInfo info = test::described("lure", "a feedback system", {"x", "y", "z"});
    info.parameters = {{"alpha", 1.2, -any, any, false, "1", "damping"}};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _alpha(bound["alpha"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = z[2];
      f[2] = z[0] * z[0] - z[2] * _alpha - z[1] - z[0];
    }

   private:
    P _alpha;
  };
};

namespace {

scene::Scene scene_of(const std::vector<std::string>& more) {
  systems::add_recorded<Lure>();
  std::vector<std::string> settings{"system={name: lure}",       "starts={fixed_points: {grid: [[0], [0], [0]]}}",
                                    "continuation.free=alpha",   "limits.parameter=[-1.4, 1.8]",
                                    "limits.period=100",         "compute.stability=true",
                                    "continuation.step=adaptive"};
  settings.insert(settings.end(), more.begin(), more.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml", settings);
}

// With t -> -t and alpha -> -alpha the equations are the same, so that what is found comes in pairs. The values are
// by an integrator that shares nothing with this program, to 1e-7.
TEST(Lure, OnlyWhatPassesTheCircleIsFoundWhereMultipliersTurn) {
  const std::vector<double> doublings{0.04471966, 0.57962984, 0.63030200};
  constexpr double fold = 0.04494912;
  const core::Communicator comm;
  for (const std::string step : {"adaptive", "0.05", "0.2"}) {
    SCOPED_TRACE(step);
    const survey::Summary summary = test::run(comm, scene_of({"survey.depth=1", "continuation.step=" + step}), "lure");
    EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
    if (!comm.is_root()) continue;
    for (const survey::FindingSummary& line : summary.findings)
      EXPECT_NE(line.severity, survey::Severity::contradiction) << line.text;
    const test::Atlas atlas(summary.atlas);
    std::vector<double> doubled;
    std::vector<double> folds;
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
      (atlas.crossings().texts("kind")[row] == "period-doubling" ? doubled : folds)
          .push_back(atlas.crossings().reals("parameter")[row]);
    std::sort(doubled.begin(), doubled.end());
    std::sort(folds.begin(), folds.end());
    ASSERT_EQ(doubled.size(), 6U);
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_NEAR(doubled[3 + n], doublings[n], 1e-7);
      EXPECT_NEAR(doubled[2 - n], -doublings[n], 1e-7);
    }
    ASSERT_EQ(folds.size(), 2U);
    EXPECT_NEAR(folds[0], -fold, 1e-7);
    EXPECT_NEAR(folds[1], fold, 1e-7);
  }
}

}  // namespace
}  // namespace lure_test
