// check_double_pendulum ATLAS: what the survey of drivers/scenes/double_pendulum.yaml must have found.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace {

using namespace orbweaver;
using ::testing::Contains;

std::unique_ptr<archive::Archive> atlas;

struct Expected {
  const char* name;
  int orbits;
  double last_energy;
};

const Expected expected[] = {
    {"In-Phase", 42, 2.999066436174782438},
    {"Out-Phase", 57, 2.999995011170102407},
    {"Down-Up", 37, 2.999963952154835231},
    {"Up-Down", 33, 2.999977702299426676},
};

struct Rows {
  std::size_t first;
  std::size_t count;
};

std::size_t row_of(const std::string& name) {
  const auto& names = atlas->families().texts("name");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::runtime_error("no family " + name);
  return static_cast<std::size_t>(found - names.begin());
}

Rows rows_of(std::size_t family) {
  return {static_cast<std::size_t>(atlas->families().integers("first_orbit")[family]),
          static_cast<std::size_t>(atlas->families().integers("orbit_count")[family])};
}

std::vector<double> column(const char* name, std::size_t family) {
  const Rows rows = rows_of(family);
  const auto& values = atlas->orbits().reals(name);
  return {values.begin() + static_cast<long>(rows.first), values.begin() + static_cast<long>(rows.first + rows.count)};
}

loop::Loop loop_of(std::size_t row) { return archive::loop_of(*atlas, row, {0, 1}); }

TEST(DoublePendulum, HasItsFourFamilies) {
  const archive::Table& families = atlas->families();
  for (const Expected& family : expected) {
    const std::size_t n = row_of(family.name);
    EXPECT_EQ(families.texts("isotropy")[n], "S@1/2 R@0");
    EXPECT_EQ(families.texts("end_reason")[n], "period limit (T = 30)");
    EXPECT_EQ(families.integers("parent")[n], -1);
    // Steps are adaptive and decided by rounding in places, which may differ between types of CPU.
    EXPECT_NEAR(static_cast<double>(rows_of(n).count), family.orbits, 2) << family.name;
  }
}

TEST(DoublePendulum, HasBranchesOfBranches) {
  for (const char* name :
       {"ID1a", "ID1b", "ID2a", "ID2b", "IB", "IBB", "IBDa", "IBDb", "ODa", "ODb", "ODbB", "OB", "OBB", "OBDa", "OBDb"})
    EXPECT_THAT(atlas->families().texts("name"), Contains(name));
}

TEST(DoublePendulum, FamiliesEndOnThePeriodLimitAtKnownEnergies) {
  for (const Expected& family : expected) {
    const std::size_t n = row_of(family.name);
    EXPECT_EQ(column("period", n).back(), 30.0);
    EXPECT_NEAR(column("energy", n).back(), family.last_energy, 1e-11) << family.name;
  }
}

TEST(DoublePendulum, EveryOrbitMeetsItsTolerance) {
  for (std::size_t row = 0; row < atlas->orbits().rows(); ++row)
    EXPECT_LT(atlas->orbits().reals("loss_rms")[row], 1e-10 * std::min(1.0, loop::rms_speed(loop_of(row))))
        << "row " << row;
}

TEST(DoublePendulum, EveryOrbitIsConfirmedByTheIntegrator) {
  for (std::size_t row = 0; row < atlas->orbits().rows(); ++row) {
    EXPECT_LT(atlas->orbits().reals("closure")[row], 1e-9) << "row " << row;
    EXPECT_LT(atlas->orbits().reals("energy_drift")[row], 1e-10) << "row " << row;
  }
}

TEST(DoublePendulum, StoredColumnsAreThoseOfTheStoredModes) {
  for (std::size_t row = 0; row < atlas->orbits().rows(); ++row) {
    const loop::Loop loop = loop_of(row);
    const std::vector<double> state = loop::state_at(loop, 0.0);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(atlas->orbits().reals("state")[4 * row + i], state[i]);
    EXPECT_EQ(atlas->orbits().reals("tail")[row], loop::tail(loop));
    const auto family = static_cast<std::size_t>(atlas->orbits().integers("family")[row]);
    if (atlas->families().integers("parent")[family] >= 0) continue;
    EXPECT_NEAR(state[2], 0.0, 1e-12);  // s = 0 is an instant of rest
    EXPECT_NEAR(state[3], 0.0, 1e-12);
  }
}

TEST(DoublePendulum, InPhaseEndsWithBothMassesUpright) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  const Rows rows = rows_of(0);
  int seen = 0;
  for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
    if (atlas->orbits().reals("period")[row] < 24.5) continue;
    ++seen;
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_LT(180.0 - std::abs(atlas->orbits().reals("state")[4 * row + i]) * degrees, 5.0) << "row " << row;
  }
  EXPECT_GE(seen, 3);
}

// The paper's figure of the integrator's error: once around a long orbit no integrator finds back, though it is one.
TEST(DoublePendulum, LongOrbitsCannotBeIntegratedOnce) {
  const std::vector<double> single = column("single_shot", 0), period = column("period", 0),
                            closure = column("closure", 0);
  EXPECT_LT(single.front(), 1e-11);
  EXPECT_GT(single.back(), 1e-3);
  EXPECT_LT(closure.back(), 1e-9);
  for (std::size_t n = 0; n < period.size(); ++n)
    EXPECT_TRUE(single[n] < 1e-8 || period[n] > 12.0) << "T = " << period[n];
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: check_double_pendulum ATLAS\n", stderr);
    return 2;
  }
  atlas = std::make_unique<archive::Archive>(argv[1]);
  const int status = RUN_ALL_TESTS();
  atlas.reset();  // before HDF5 closes at exit
  return status;
}
