// Three oscillations of one equilibrium at 1 : 2 : 3: which families leave is known by their number.
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/three_oscillators.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"
#include "tasks/payload/keys.hpp"
#include "witness/witness.hpp"

namespace three_oscillators_test {
namespace {

using namespace orbweaver;
using testing::HasSubstr;
using testing::SizeIs;

scene::Scene scene_of(std::vector<std::string> settings) {
  systems::add_recorded<test::ThreeOscillators>();
  settings.insert(settings.begin(),
                  {"system.name=three_oscillators", "starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                   "starts.fixed_points.grid=[[0], [0], [0]]", "starts.sweep.period=auto", "survey.depth=0",
                   "limits.energy=[-.inf, .inf]", "limits.steps=4"});
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", settings);
}

// Of the terms of third order: two pairs along all three, whose periods grow and fall, one without the second, and the
// own ones of the two that are faster (docs/mathematics.md, "What adds up").
TEST(ThreeOscillators, AllFamiliesLeaveWhateverTheToleranceAndTheFirstStep) {
  const core::Communicator comm;
  for (const auto& [first, tolerance] :
       {std::pair{"0.003", "1e-10"}, {"0.0087", "1e-8"}, {"0.0087", "1e-11"}, {"0.02", "1e-10"}}) {
    const std::string told = std::string(first) + " " + tolerance;
    const survey::Summary summary = test::run(
        comm,
        scene_of({std::string("continuation.start=") + first, std::string("continuation.tolerance=") + tolerance}),
        "three");
    EXPECT_EQ(summary.failures, 0U) << told;
    if (!comm.is_root()) continue;
    EXPECT_THAT(summary.families, SizeIs(7)) << told;
    for (const survey::FindingSummary& line : summary.findings)
      EXPECT_EQ(line.severity, survey::Severity::cut) << told << ": " << line.text;
  }
}

// The indices of what leaves add up to three, the number of oscillations: a family of an index that is not there is
// missed, and said.
TEST(ThreeOscillators, AFamilyThatIsMissedIsSaid) {
  const core::Communicator comm;
  const scene::Scene scene = scene_of({});
  const survey::Summary summary = test::run(comm, scene, "three_missed");
  int sum = 0;
  int told = 0;
  for (int missing = 0; missing < 7; ++missing) {
    survey::WitnessInput input;
    survey::KernelRecord kernel;
    kernel.dimension = 3;
    kernel.is_definite = true;
    for (int place = 0; place < 7; ++place) {
      if (place == missing) continue;
      kernel.places.push_back(place);
      kernel.images.push_back(1);
      kernel.repetitions.push_back(place < 5 ? 1 : place - 3);
    }
    input.kernels = {{kernel}};
    if (comm.is_root()) {
      const test::Atlas atlas(summary.atlas);
      for (int place = 0; place < 7; ++place) input.family_keys.push_back(survey::base_key(0, place));
      ASSERT_EQ(atlas.families().rows(), input.family_keys.size());
    }
    const auto said = survey::testify(comm, summary.atlas, scene, scene::bound_system(scene.system), std::move(input));
    ASSERT_TRUE(said.has_value());
    if (!comm.is_root()) continue;
    for (const archive::FindingRecord& line : said->records) {
      if (line.kind != "equilibrium-families") continue;
      EXPECT_EQ(line.severity, "contradiction");
      EXPECT_THAT(line.text, HasSubstr(missing < 5 ? "(1 : 2 : 3, " : missing == 5 ? "(1 : 3, " : "(1 : 2, "));
      sum += static_cast<int>(line.deviation);
      ++told;
    }
  }
  if (!comm.is_root()) return;
  EXPECT_EQ(sum, 3);
  EXPECT_GE(told, 3);
}

}  // namespace
}  // namespace three_oscillators_test
