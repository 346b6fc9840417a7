// Crossings that an index passes with the third and the fifth power of the distance: its error leaves the place open.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"

namespace flat_crossings_test {

using namespace orbweaver;

/// x'' + (delta + eps cos t) x + x^3 = 0. At eps = 0 it is autonomous: what goes around m times there is one orbit at
/// every phase, and families in eps cross that circle of orbits, exactly there.
class Mathieu {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    systems::ModelInfo info = test::described("mathieu", "a driven cubic spring", {"x", "v", "phase"});
    constexpr double any = std::numeric_limits<double>::infinity();
    info.winding_names = {"", "", "turns"};
    info.parameters = {{"delta", 1.2, -any, any, false, "1", "stiffness"},
                       {"eps", 0.0, -any, any, false, "1", "how it is driven"}};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.symplectic = true;
    structure.driven = true;
    structure.angles = {2};
    structure.equivariances = {{"S", Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix()}};
    structure.reversors = {{"R", Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix()},
                           {"RS", Eigen::Vector3d(-1, 1, -1).asDiagonal().toDenseMatrix()}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _delta(bound["delta"]), _eps(bound["eps"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::cos;
      f[0] = z[1];
      f[1] = -(_delta + _eps * cos(z[2])) * z[0] - z[0] * z[0] * z[0];
      f[2] = S(1.0);
    }

   private:
    P _delta, _eps;
  };
};

namespace {

class FlatCrossings : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world = std::make_unique<core::Communicator>();
    systems::add_recorded<Mathieu>();
    const scene::Scene scene =
        scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml",
                    {"system={name: mathieu}", "starts={fixed_points: {grid: [[0]]}}", "continuation={free: eps}",
                     "survey={depth: 1}", "limits={parameter: [-8, 8], period: 30}", "compute={stability: true}"});
    found = test::run(*world, scene, "flat");
  }
  static void TearDownTestSuite() { world.reset(); }

  static inline std::unique_ptr<core::Communicator> world;
  static inline survey::Summary found;
};

/// The families whose orbits pass eps = 0 have a branch point there. Where it is listed, and how far off it may be
/// said to be, go together; and no other crossing is said to be off by what its place is known to.
TEST_F(FlatCrossings, SayHowFarTheyMayLieFromTheirPlaces) {
  const test::Atlas atlas(found.atlas);
  const archive::Table& crossings = atlas.crossings();
  int flat = 0;
  for (std::size_t row = 0; row < crossings.rows(); ++row) {
    const double eps = crossings.reals("parameter")[row];
    const double off = crossings.reals("place_error_parameter")[row];
    EXPECT_TRUE(std::isfinite(crossings.reals("place_error")[row])) << row;
    EXPECT_LE(crossings.reals("place_error_period")[row], 1e-12) << "the drive holds it";
    if (crossings.texts("kind")[row] == "branch-point" && std::abs(eps) < 0.01) {
      ++flat;
      EXPECT_LE(std::abs(eps), off) << row;
      EXPECT_LE(off, 0.05) << row;  // the index's bound is 1e-7 at most, and it goes with the fifth power at most
    } else {
      EXPECT_LE(off, 1e-6) << row;
    }
  }
  EXPECT_GE(flat, 4);
  const auto& kinds = atlas.findings().texts("kind");
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "open-place"), flat);
  EXPECT_EQ(found.failures, 0U);
}

TEST_F(FlatCrossings, AreVerifiedAndErrorsThatAreTooSmallAreFound) {
  const test::Atlas atlas(found.atlas);
  archive::Records records = test::complete_records_of(atlas);
  EXPECT_THAT(survey::verify(*world, found.atlas).objections, ::testing::IsEmpty());
  std::vector<std::int64_t> forged;
  for (std::size_t row = 0; row < records.crossings.size(); ++row) {
    archive::CrossingRecord& crossing = records.crossings[row];
    if (std::abs(crossing.parameter) > 0.01) continue;
    (forged.size() % 2 == 0 ? crossing.place_error : crossing.place_error_parameter) *= 0.1;
    forged.push_back(static_cast<std::int64_t>(row));
  }
  ASSERT_GE(forged.size(), 4U);
  const auto folder = test::fresh_folder("flat_forged");
  test::write_sample_atlas(folder, atlas.header(), records);
  const survey::Verification verified = survey::verify(*world, folder / "atlas.h5");
  for (const std::int64_t row : forged)
    EXPECT_TRUE(std::any_of(verified.objections.begin(), verified.objections.end(), [&](const auto& objection) {
      return objection.table == "crossings" && objection.row == row && objection.column.starts_with("place_error");
    })) << row;
}

}  // namespace
}  // namespace flat_crossings_test
