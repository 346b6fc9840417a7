// Systems drawn by chance: each is surveyed without a failure, and what it stores is verified.
#include "support/drawn_systems.hpp"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"

namespace drawn_systems_test {
namespace {

using namespace orbweaver;

constexpr std::uint64_t seed = 0x21a3da43;  // the commit from which they were first drawn

void survey_and_verify(int count) {
  const core::Communicator comm;
  for (const test::DrawnSystem& drawn : test::SystemDrawing(seed).draw(count)) {
    SCOPED_TRACE(drawn.name + " " + drawn.settings.front());
    const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/tests/survey/drawn.yaml", drawn.settings);
    const survey::Summary summary = test::run(comm, scene, drawn.name);
    EXPECT_EQ(summary.failures, 0U);
    for (const survey::Objection& o : survey::verify(comm, summary.atlas).objections)
      ADD_FAILURE() << fmt::format("/{}/{} row {}: {}", o.table, o.column, o.row, o.text);
    if (!comm.is_root()) continue;
    for (const survey::FindingSummary& line : summary.findings)
      EXPECT_NE(line.severity, survey::Severity::contradiction) << line.text;
    const test::Atlas atlas(summary.atlas);
    EXPECT_GE(atlas.families().rows(), 1U);
    EXPECT_GE(atlas.orbits().rows(), 8U);
  }
}

TEST(DrawnSystems, AreSurveyed) { survey_and_verify(8); }

TEST(LongDrawnSystems, AreSurveyed) { survey_and_verify(40); }

}  // namespace
}  // namespace drawn_systems_test
