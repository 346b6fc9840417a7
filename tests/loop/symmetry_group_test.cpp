#include "orbweaver/loop/symmetry/symmetry_group.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::symmetry_group_test {
namespace {

using systems::AffineMap;
using test::element_of;
using Texts = std::vector<std::string>;

constexpr double pi = std::numbers::pi;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

Texts texts(const systems::Structure& structure, const Isotropy& generators) {
  Texts out;
  const SymmetryGroup group(structure, generators);
  for (const SymmetryElement& e : group.elements()) out.push_back(to_text({e}));
  std::sort(out.begin(), out.end());
  return out;
}

TEST(SymmetryGroup, HoldsAllProducts) {
  EXPECT_EQ(texts(pendulum(), {}), Texts{"1@0"});
  EXPECT_EQ(texts(pendulum(), {element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")}),
            (Texts{"1@0", "R@0", "RS@1/2", "S@1/2"}));
  EXPECT_EQ(texts(pendulum(), {element_of(pendulum(), "S", 1, 4)}), (Texts{"1@0", "1@1/2", "S@1/4", "S@3/4"}));
  EXPECT_EQ(texts(pendulum(), {element_of(pendulum(), "R", 1, 4), element_of(pendulum(), "RS", 3, 4)}),
            (Texts{"1@0", "R@1/4", "RS@3/4", "S@1/2"}));
  EXPECT_EQ(texts(galaxy(), {element_of(galaxy(), "C", 1, 3), element_of(galaxy(), "RS")}).size(), 6u);
}

// Each element of the group is a symmetry of any loop that has the generators.
TEST(SymmetryGroup, HoldsForTheLoop) {
  for (const Isotropy& generators : {Isotropy{element_of(galaxy(), "C", 1, 3), element_of(galaxy(), "RS")},
                                     Isotropy{element_of(galaxy(), "S", 1, 4), element_of(galaxy(), "R", 1, 3)}}) {
    const Loop loop =
        test::random_loop_in(Subspace(4, 8, generators), constant_loop(std::vector<double>(4, 0.0), 5.0, 8), 71);
    const SymmetryGroup group(galaxy(), generators);
    for (const SymmetryElement& e : group.elements()) EXPECT_LT(symmetry_defect(loop, e, {}), 1e-13) << to_text({e});
  }
}

TEST(SymmetryGroup, OfSpaceNamesProducts) {
  Texts names;
  const SymmetryGroup group = SymmetryGroup::of_space(galaxy());
  for (const SymmetryElement& e : group.elements()) names.push_back(e.name);
  EXPECT_EQ(names, (Texts{"1", "C", "CC", "S", "SC", "SCC", "R", "RS", "RSC", "RSCC", "RC", "RCC"}));
}

// A half turn of the plane and a third of a turn, which commute.
systems::Structure sixfold() {
  systems::Structure structure = test::structure_of(2);
  Eigen::Matrix2d third_turn;
  third_turn << -0.5, -0.5 * std::numbers::sqrt3, 0.5 * std::numbers::sqrt3, -0.5;
  structure.equivariances = {{"S", -Eigen::Matrix2d::Identity()}, {"C", third_turn}};
  return structure;
}

TEST(SymmetryGroup, TheLeastShiftMayBelongToAProduct) {
  const systems::Structure structure = sixfold();
  const Isotropy isotropy{element_of(structure, "S", 1, 2), element_of(structure, "C", 1, 3)};
  const SymmetryGroup group(structure, isotropy);
  EXPECT_EQ(group.order(), 6);
  Eigen::Matrix2d sixth_turn;
  sixth_turn << 0.5, -0.5 * std::numbers::sqrt3, 0.5 * std::numbers::sqrt3, 0.5;
  EXPECT_LT((group.generator().matrix - sixth_turn).norm(), 1e-14);
  const FundamentalDomain domain = fundamental_domain(structure, isotropy);
  EXPECT_EQ(domain.order, 6);
  EXPECT_TRUE(domain.expresses(isotropy));
  EXPECT_EQ(domain.coordinates_with_mean(), (std::vector<bool>{false, false}));
}

// C@1/2 generates 1@1/2 as well, whose square is the identity: maps around the loop close with that one.
TEST(SymmetryGroup, TheMapIsOneWhosePowersClose) {
  const systems::Structure structure = sixfold();
  const SymmetryGroup group(structure, {element_of(structure, "C", 1, 2)});
  EXPECT_EQ(group.order(), 2);
  EXPECT_EQ(group.elements().size(), 6U);
  EXPECT_LT((group.generator().matrix - Eigen::Matrix2d::Identity()).norm(), 1e-14);
}

TEST(SymmetryGroup, APartThatIsAGroupHasAMapOfItsOwn) {
  const systems::Structure structure = sixfold();
  const SymmetryGroup all(structure, {element_of(structure, "S", 1, 2), element_of(structure, "C", 1, 3)});
  const SymmetryGroup part = all.subgroup([](const SymmetryElement& e) { return e.shift_denominator % 2 == 1; });
  EXPECT_EQ(part.order(), 3);
  EXPECT_LT((part.generator().matrix - structure.equivariances[1].map.matrix).norm(), 1e-14);
  EXPECT_THROW((void)all.subgroup([](const SymmetryElement& e) { return e.shift_denominator != 6; }),
               core::MisuseError);
}

TEST(SymmetryGroup, KnowsItsReversors) {
  const SymmetryGroup away(pendulum(), {element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R", 1, 2)});
  EXPECT_EQ(to_text({*away.reversor()}), "R@1/2");
  EXPECT_EQ(to_text({*away.reversor_at_start()}), "RS@0");
  EXPECT_EQ(SymmetryGroup(pendulum(), {element_of(pendulum(), "R", 1, 4)}).reversor_at_start(), nullptr);
  EXPECT_EQ(SymmetryGroup(pendulum(), {element_of(pendulum(), "S", 1, 2)}).reversor(), nullptr);
}

// Turning an angle by a third of a turn: the same matrix as the identity, told apart by the offset modulo whole turns.
TEST(SymmetryGroup, OffsetsOfAnglesCountModuloWholeTurns) {
  systems::Structure ring = test::structure_of(2);
  ring.angles = {0};
  ring.equivariances = {{"C", {Eigen::Matrix2d::Identity(), Eigen::Vector2d(2.0 * pi / 3.0, 0.0)}}};
  const SymmetryGroup group(ring, {element_of(ring, "C", 1, 3)});
  EXPECT_EQ(texts(ring, {element_of(ring, "C", 1, 3)}), (Texts{"1@0", "C@1/3", "CC@2/3"}));
  EXPECT_EQ(group.order(), 3);
  EXPECT_NEAR(group.generator().offset(0), 2.0 * pi / 3.0, 1e-15);
}

}  // namespace
}  // namespace orbweaver::loop::symmetry_group_test
