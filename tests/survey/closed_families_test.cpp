// Families in a parameter that are closed curves: each is one family, once around, whatever the steps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/isola.hpp"
#include "survey/atlas.hpp"

namespace closed_families_test {
namespace {

using namespace orbweaver;

constexpr double turn = 2.0 * std::numbers::pi;

/// A start on the cycle with this s at lam = 0.
std::string start(const std::string& name, double s, double radius = 1.0, double bend = 0.0, double period = turn) {
  const double x = std::sqrt(1.0 + s);
  return fmt::format("{{state: [{:.17g}, {:.17g}, 0, 0], period: {:.17g}, name: {}}}", radius * x,
                     radius * bend * x * x, period, name);
}

survey::Summary survey_of(const std::string& parameters, const std::string& starts, double most,
                          const std::vector<std::string>& more = {}) {
  systems::add_recorded<test::Isola>();
  const core::Communicator comm;
  std::vector<std::string> all{"system={name: isola, parameters: {" + parameters + "}}",
                               "starts={states: [" + starts + "]}",
                               "continuation.free=lam",
                               fmt::format("limits.parameter=[{}, {}]", -most, most),
                               "limits.period=1e5",
                               "compute.stability=true"};
  all.insert(all.end(), more.begin(), more.end());
  return test::run(comm, scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml", all), "closed");
}

/// Each of `families` closes, with one fold at `fold` and one at -`fold`, and nothing contradicts it.
void expect_closed(const survey::Summary& summary, std::size_t families, double fold, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_EQ(summary.failures, 0U);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  const test::Atlas atlas(summary.atlas);
  std::size_t closed = 0;
  for (std::size_t family = 0; family < atlas.families().rows(); ++family) {
    if (atlas.families().texts("end_reason")[family].rfind("closed loop", 0) != 0) continue;
    ++closed;
    const std::vector<double> lam = atlas.column("parameter", atlas.families().texts("name")[family]);
    EXPECT_NEAR(lam.front(), lam.back(), 1e-6 * fold) << "the last orbit is the first";
    std::vector<double> folds;
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
      if (atlas.crossings().texts("kind")[row] == "fold-parameter" &&
          atlas.crossings().integers("family")[row] == static_cast<std::int64_t>(family))
        folds.push_back(atlas.crossings().reals("parameter")[row]);
    ASSERT_EQ(folds.size(), 2U);
    EXPECT_NEAR(std::max(folds[0], folds[1]), fold, 1e-8 * fold);
    EXPECT_NEAR(std::min(folds[0], folds[1]), -fold, 1e-8 * fold);
  }
  EXPECT_EQ(closed, families);
}

TEST(ClosedFamilies, OfOnePeriodAndOfMany) {
  for (const char* setting : {"step=adaptive", "step=0.01", "step=0.04", "step=0.08", "step=0.16", "tolerance=1e-11"}) {
    const std::vector<std::string> more{std::string("continuation.") + setting};
    const survey::Summary circles = survey_of("lam: 0, a: 0.04", start("Isola", 0.2), 1.0, more);
    const survey::Summary bent =
        survey_of("lam: 0, a: 0.04, k: 0.3, c: 0.3", start("Isola", 0.2, 1.0, 0.3, turn / 1.06), 1.0, more);
    if (!core::Communicator().is_root()) continue;
    expect_closed(circles, 1, 0.2, fmt::format("circles, {}", setting));
    expect_closed(bent, 1, 0.2, fmt::format("bent, {}", setting));
  }
}

TEST(ClosedFamilies, InOtherUnits) {
  const survey::Summary summary = survey_of("lam: 0, a: 0.04, k: 0.3, c: 0.3, R: 1000, L: 1000, w: 0.001",
                                            start("Isola", 0.2, 1000.0, 0.3, 1000.0 * turn / 1.06), 1000.0);
  if (core::Communicator().is_root()) expect_closed(summary, 1, 200.0, "thousands");
}

/// The way back passes the first orbit at a distance far below a step, and is not it.
TEST(ClosedFamilies, AThinOneIsFollowedAllAround) {
  for (const char* thin : {"1.6e-5, L: 1000", "1.6e-7, L: 10000"}) {
    const double s = std::sqrt(std::atof(thin));
    const survey::Summary summary = survey_of(std::string("lam: 0, a: ") + thin, start("Isola", s), 100.0);
    if (core::Communicator().is_root()) expect_closed(summary, 1, 4.0, thin);
  }
}

TEST(ClosedFamilies, TwoSideBySideAreTwo) {
  const std::string starts = start("In", 0.2) + ", " + start("Out", 0.8 + std::sqrt(1.04));
  const survey::Summary summary = survey_of("lam: 0, a: 0.04, q: 1", starts, 1.0);
  if (core::Communicator().is_root()) expect_closed(summary, 2, 0.2, "two");
}

/// At lam = -0.1 its period doubles twice. What is born there joins the two.
TEST(ClosedFamilies, WithDoublingsThatAreLeftOutOrFollowed) {
  for (const int depth : {0, 1}) {
    const survey::Summary summary =
        survey_of("lam: 0, a: 0.04, g: 0.1", start("Isola", 0.2), 1.0, {fmt::format("survey.depth={}", depth)});
    if (!core::Communicator().is_root()) continue;
    expect_closed(summary, 1, 0.2, fmt::format("depth {}", depth));
    EXPECT_EQ(summary.families.size(), depth == 0 ? 1U : 2U);
    const test::Atlas atlas(summary.atlas);
    std::size_t doublings = 0;
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
      if (atlas.crossings().texts("kind")[row] != "period-doubling" || atlas.crossings().integers("family")[row] != 0)
        continue;
      ++doublings;
      EXPECT_NEAR(atlas.crossings().reals("parameter")[row], -0.1, 1e-9);
    }
    EXPECT_EQ(doublings, 2U);
  }
}

}  // namespace
}  // namespace closed_families_test
