// Crossings of higher order than the scene asks for are known by the branches that end there alone: what the archive
// says of them is what their families say. And crossings beside folds, where the energy turns and the period goes on.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "survey/scenes.hpp"

namespace high_orders_test {
namespace {

using namespace orbweaver;

TEST(HighOrders, AreToldInTheTermsOfTheirFamilyAndVerified) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
                  {"system.parameters.m2=0.3", "starts.fixed_points.grid=[[0], [0]]", "starts.fixed_points.names={}",
                   "starts.fixed_points.letters={}", "survey.depth=1", "survey.subharmonics=4", "limits.period=24",
                   "limits.energy=[-.inf, 1.1]"});
  const survey::Summary summary = test::run(comm, scene, "high_orders");
  EXPECT_EQ(summary.failures, 0U);
  for (const survey::Objection& o : survey::verify(comm, summary.atlas).objections)
    ADD_FAILURE() << o.table << "/" << o.column << " row " << o.row << ": " << o.text;
  const test::Atlas atlas(summary.atlas);
  // The family of mode 2 is its own image half a period later, so that its fundamental map is that of half a period.
  const std::vector<std::int64_t>& multiplicity = atlas.crossings().integers("multiplicity");
  const auto found = std::find(multiplicity.begin(), multiplicity.end(), 5);
  ASSERT_NE(found, multiplicity.end());
  const auto row = static_cast<std::size_t>(found - multiplicity.begin());
  EXPECT_EQ(atlas.crossings().integers("fundamental_order")[row], 2);
  EXPECT_EQ(atlas.crossings().integers("sector_q")[row], 5);
  EXPECT_EQ(atlas.crossings().integers("sector_j")[row], 1);
  EXPECT_NEAR(atlas.crossings().reals("test_value")[row], 2.0 * std::cos(2.0 * std::numbers::pi / 5.0), 1e-9);
}

}  // namespace
}  // namespace high_orders_test
