// An archive whose formulas are missing, as of a system that came from a plugin: it is opened, shown, drawn and
// compared by its modes; what needs the field says so.
#include <cmath>
#include <string>

#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/refine/stored_family.hpp"
#include "orbweaver/report/compare/comparison.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "page/page_index.hpp"
#include "plot/diagrams.hpp"
#include "plot/orbit_pictures.hpp"

namespace missing_formulas_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string scene_with_plugin =
    "system:\n  plugin: ./two_masses.so\n  parameters: {k: 1}\n  plugin_source: "
    "b9666efa4c554df91d1f7720fe7a1880762a0547\n"
    "  plugin_abi: 1\nstarts: {}\ncontinuation: {tolerance: 1e-9}\nsection: {coordinate: p}\n";

/// x = r cos, p = -r sin of a spring that softens: T = 2 pi (1 + r^2/10), E = r^2/2; `turned`: p has another sign, the
/// same numbers and other loops.
std::filesystem::path spring(const std::string& folder, double k, bool turned = false) {
  archive::Header header;
  header.orbweaver_version = "0.1.0";
  header.scene = scene_with_plugin;
  header.state_names = {"x", "p"};
  header.pairs = 0;
  header.system = "spring";
  header.parameter_names = {"k"};
  header.parameter_values = {k};
  archive::Records records;
  archive::FamilyRecord family;
  family.key = "0001";
  family.name = "Spring";
  family.end_reason = "energy limit";
  records.families.push_back(family);
  for (int step = 0; step < 6; ++step) {
    const double r = 0.5 + 0.1 * step;
    archive::OrbitRecord orbit;
    orbit.family_key = family.key;
    orbit.step = step;
    orbit.arclength = r;
    orbit.period = 2.0 * M_PI * (1.0 + r * r / 10.0);
    orbit.energy = r * r / 2.0;
    orbit.action = M_PI * r * r;
    orbit.cutoff = 1;
    orbit.modes = {0.0, 0.0, r, 0.0, 0.0, turned ? r : -r};
    orbit.state = {r, 0.0};
    records.orbits.push_back(orbit);
    records.sections.push_back({family.key, step, 0.0, {r, 0.0}});
  }
  return test::write_sample_atlas(test::fresh_folder("missing_" + folder), header, records);
}

TEST(MissingFormulas, AreSaidInOneLineByWhatNeedsThem) {
  const archive::Archive atlas(spring("used", 1.0));
  const auto says =
      AllOf(HasSubstr("system.plugin: expected the system's formulas, got none"), testing::Not(HasSubstr("\n")));
  EXPECT_THAT([&] { static_cast<void>(survey::scaled_system_of(atlas)); }, ThrowsMessage<core::InputError>(says));
  EXPECT_THAT([&] { static_cast<void>(refine::StoredFamily(atlas, 0)); }, ThrowsMessage<core::InputError>(says));
}

TEST(MissingFormulas, AreNoneThatTablesAndPicturesNeed) {
  const archive::Archive atlas(spring("shown", 1.0));
  EXPECT_THAT(report::index_members(atlas), HasSubstr("two_masses.so"));
  EXPECT_FALSE(report::tree_figure(atlas, {"tree", {}, {}}).series.empty());
  EXPECT_FALSE(report::orbit_figures(atlas, {"orbit", {"Spring"}, {}}).empty());
  EXPECT_FALSE(report::section_figures(atlas, {"section", {"Spring"}, {}}).empty());
  const report::Figure accuracy = report::accuracy_figure(atlas, {"accuracy", {"Spring"}, {}});
  EXPECT_EQ(accuracy.series.front().points.front().y, 1e-9);  // the scene's tolerance
}

TEST(MissingFormulas, LeaveLoopsToBeComparedByTheirModes) {
  const archive::Archive a(spring("a", 1.0));
  const report::Comparison same = report::compare(a, archive::Archive(spring("b", 1.0)), {.loops = 2});
  EXPECT_TRUE(same.same());
  EXPECT_EQ(same.families, 1U);
  EXPECT_EQ(same.loops, 2U);
  EXPECT_THAT(same.notes, testing::Contains(HasSubstr("the formulas are missing")));
  EXPECT_FALSE(report::compare(a, archive::Archive(spring("c", 2.0))).same()) << "another parameter";
  EXPECT_EQ(report::compare(a, archive::Archive(spring("d", 1.0, true)), {.loops = 2}).loops, 0U)
      << "an image under a symmetry, or another loop: that is not known";
}

}  // namespace
}  // namespace missing_formulas_test
