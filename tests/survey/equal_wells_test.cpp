// A row of equal wells: as many families with the same periods and energies, each about another place.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"

namespace equal_wells_test {
namespace {

using namespace orbweaver;

/// q'' = -sin q, with q no angle.
class EqualWells {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() { return test::described("equal_wells", "a row of equal wells", {"q", "p"}); }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>&) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::sin;
      f[0] = z[1];
      f[1] = -sin(z[0]);
    }
    template <int, class S>
    S conserved(const S* z) const {
      using std::cos;
      return z[1] * z[1] * 0.5 - cos(z[0]);
    }
    template <class S>
    S action_density(const S* z) const {
      return z[1] * z[1];
    }
  };
};

// A comparison of loops for each pair of them would take minutes, and half a gigabyte for 500.
TEST(EqualWells, AThousandFamiliesOfOnePeriodAreNotComparedByLoops) {
  constexpr int wells = 1000;
  constexpr double most_mib = 200.0;
  systems::add_recorded<EqualWells>();
  std::vector<std::string> places(wells);
  for (int n = 0; n < wells; ++n) places[static_cast<std::size_t>(n)] = fmt::format("{}", 2.0 * std::numbers::pi * n);
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml",
                  {"system={name: equal_wells}",
                   fmt::format("starts={{fixed_points: {{grid: [[{}], [0]]}}}}", fmt::join(places, ", ")),
                   "limits={period: 6.6, families: 5000}", "survey.depth=0", "compute.stability=false"});
  const survey::Summary summary = test::run(comm, scene, "equal_wells");
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.families.size(), static_cast<std::size_t>(wells));
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  EXPECT_LT(*std::max_element(summary.peak_memory_mib.begin(), summary.peak_memory_mib.end()), most_mib);
}

}  // namespace
}  // namespace equal_wells_test
