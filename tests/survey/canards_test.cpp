// FitzHugh and Nagumo's equations: their family explodes, and turns where its parameter hardly changes along many
// orbits.
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"

namespace canards_test {

using namespace orbweaver;

/// v' = v - v^3/3 - w + I, w' = eps (v + a - b w). With (v, w) -> (-v, 2a/b - w) and I -> 2a/b - I it is the same.
class FitzHughNagumo {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    constexpr double any = std::numeric_limits<double>::infinity();
    systems::ModelInfo info = test::described("fitzhugh_nagumo", "a neuron", {"v", "w"});
    info.parameters = {{"I", 0.0, -any, any, false, "1", "current"},
                       {"eps", 0.08, 0.0, any, true, "1", "how slow w is"},
                       {"a", 0.7, -any, any, false, "1", "shift"},
                       {"b", 0.8, 0.0, any, true, "1", "slope"}};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _current(bound["I"]), _eps(bound["eps"]), _a(bound["a"]), _b(bound["b"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] - z[0] * z[0] * z[0] / S(3.0) - z[1] + _current;
      f[1] = (z[0] + _a - z[1] * _b) * _eps;
    }

   private:
    P _current, _eps, _a, _b;
  };
};

namespace {

scene::Scene scene_of(const std::vector<std::string>& more) {
  systems::add_recorded<FitzHughNagumo>();
  std::vector<std::string> settings{"system={name: fitzhugh_nagumo}",
                                    "starts={fixed_points: {grid: [[-1.2], [-0.6]]}}",
                                    "continuation.free=I",
                                    "limits.parameter=[0, 2]",
                                    "limits.period=200",
                                    "compute.stability=true"};
  settings.insert(settings.end(), more.begin(), more.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml", settings);
}

constexpr double sum_of_images = 2.0 * 0.7 / 0.8;

// Both folds are told by the multiplier that passes 1 there, at values of I whose sum the equations' symmetry gives.
TEST(Canards, FoldsThatTheParameterHidesAreToldByTheMultiplier) {
  const core::Communicator comm;
  for (const std::string tolerance : {"1e-10", "1e-11"}) {
    const survey::Summary summary = test::run(comm, scene_of({"continuation.tolerance=" + tolerance}), "canards");
    EXPECT_EQ(summary.failures, 0U) << tolerance;
    for (const survey::Objection& o : survey::verify(comm, summary.atlas).objections)
      EXPECT_NE(o.table, "crossings") << tolerance << ", row " << o.row << ": " << o.text;
    if (!comm.is_root()) continue;
    for (const survey::FindingSummary& line : summary.findings)
      EXPECT_NE(line.severity, survey::Severity::contradiction) << tolerance << ": " << line.text;
    const test::Atlas atlas(summary.atlas);
    std::vector<double> folds;
    std::vector<double> periods;
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
      EXPECT_EQ(atlas.crossings().texts("kind")[row], "fold-parameter") << tolerance;
      folds.push_back(atlas.crossings().reals("parameter")[row]);
      periods.push_back(atlas.crossings().reals("period")[row]);
    }
    ASSERT_EQ(folds.size(), 2U) << tolerance;
    EXPECT_NEAR(folds[0] + folds[1], sum_of_images, 1e-11) << tolerance;
    EXPECT_NEAR(periods[0], periods[1], 1e-4) << tolerance;
  }
}

// Without multipliers nothing tells where it turns.
TEST(Canards, FoldsThatNothingTellsAreUndecided) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, scene_of({"compute.stability=false", "survey.depth=0"}), "canards_untold");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  int hidden = 0;
  for (const survey::FindingSummary& line : summary.findings) {
    EXPECT_NE(line.severity, survey::Severity::contradiction) << line.text;
    if (line.text.find("where is hidden by rounding") == std::string::npos) continue;
    EXPECT_EQ(line.severity, survey::Severity::undecided);
    EXPECT_THAT(line.text, testing::AnyOf(testing::HasSubstr("I turns near 0.3241785"),
                                          testing::HasSubstr("I turns near 1.4258214")));
    ++hidden;
  }
  EXPECT_EQ(hidden, 2);
}

// At half the eps the multiplier passes 1 where it is known to 5e19 only, along more orbits than are kept.
TEST(Canards, ZerosThatErrorBoundsCoverForLongAreUndecided) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm, scene_of({"system={name: fitzhugh_nagumo, parameters: {eps: 0.04}}", "limits.period=400"}), "canards_long");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  int covered = 0;
  for (const survey::FindingSummary& line : summary.findings) {
    EXPECT_EQ(line.severity, survey::Severity::undecided) << line.text;
    covered += line.text.find("within its error bound") == std::string::npos ? 0 : 1;
  }
  EXPECT_GE(covered, 1);
}

}  // namespace
}  // namespace canards_test
