// Which coordinate winds: every reader takes it from the archive, so that of a driven orbit the phase turns, not x.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/core/error.hpp"
#include "page/page_index.hpp"
#include "plot/orbit_pictures.hpp"
#include "stored_system.hpp"

namespace winding_readers_test {
namespace {

using namespace orbweaver;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// x = cos s, v = -sin s, phase = s, of a system of that name.
std::filesystem::path driven(const std::string& system) {
  archive::Header header;
  header.orbweaver_version = "9";
  header.scene = "system: driven\n";
  header.state_names = {"x", "v", "phase"};
  header.winding_names = {"n_phase"};
  header.winding_coordinates = {2};
  header.pairs = 2;
  header.symplectic = false;
  header.system = system;
  header.effects = {"damping", "drive"};
  header.parameter_names = {"drive_frequency"};
  header.parameter_values = {1.0};
  archive::Records records;
  archive::FamilyRecord family;
  family.key = "0001";
  family.name = "Response";
  family.end_reason = "parameter limit";
  records.families.push_back(family);
  archive::OrbitRecord orbit;
  orbit.family_key = family.key;
  orbit.period = 2.0 * M_PI;
  orbit.cutoff = 1;
  orbit.modes = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0};
  orbit.winding = {1.0};
  orbit.state = {1.0, 0.0, 0.0};
  orbit.stability = {0.5, 0.0, 0.25, 0.0};
  records.orbits.push_back(orbit);
  return test::write_sample_atlas(test::fresh_folder("driven_" + system), header, records);
}

TEST(WindingReaders, TurnThePhaseOfASystemThatIsNotKnown) {
  const archive::Archive atlas(driven("nobodys_system"));
  EXPECT_THAT(
      loop::state_at(archive::loop_of(atlas, 0), M_PI),
      ElementsAre(testing::DoubleNear(-1.0, 1e-14), testing::DoubleNear(0.0, 1e-14), testing::DoubleNear(M_PI, 1e-14)));
  EXPECT_THAT(report::index_members(atlas), HasSubstr("\"angles\":[2]"));
  for (const report::Figure& figure : report::orbit_figures(atlas, {"orbit", {"Response"}, {}}))
    for (const report::PlotPoint& point : figure.series.front().points) EXPECT_LE(std::hypot(point.x, point.y), 1.001);
}

TEST(WindingReaders, KnowThoseOfOlderArchivesByTheirSystem) {
  const std::filesystem::path known = driven("duffing");
  test::remove_checksums(known);  // which makes it one of format_minor 1
  EXPECT_THAT(report::angles_of(archive::Archive(known)), ElementsAre(2));
  const std::filesystem::path unknown = driven("nobodys_system");
  test::remove_checksums(unknown);
  const archive::Archive atlas(unknown);
  EXPECT_EQ(report::known_angles_of(atlas.header()), std::nullopt);
  EXPECT_THROW(static_cast<void>(archive::loop_of(atlas, 0)), core::InputError);
  try {
    static_cast<void>(report::orbit_figures(atlas, {"orbit", {"Response"}, {}}));
    FAIL() << "which coordinate winds is not known";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("does not say which coordinates wind"));
    EXPECT_THAT(error.what(), HasSubstr("the formulas of its system nobodys_system are missing"));
  }
}

}  // namespace
}  // namespace winding_readers_test
