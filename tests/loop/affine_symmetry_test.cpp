// Symmetries with an offset: about another origin everything is as about the first, moved along.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "support/stated_system.hpp"
#include "support/translated_system.hpp"

namespace orbweaver::loop::affine_symmetry_test {
namespace {

using test::element_of;

constexpr double pi = std::numbers::pi;
constexpr double irrational = 0.3141592653589793;

const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

struct Moved {
  Eigen::VectorXd offset;
  systems::Structure structure;
};

const Moved& moved() {
  static const Moved known = [] {
    Moved out{Eigen::Vector4d(3.0, -7.0, 0.4, 11.0), {}};
    out.structure = test::translated(galaxy(), out.offset);
    return out;
  }();
  return known;
}

Loop there(const Loop& loop) { return test::translated(loop, moved().offset); }

Loop sample(const Isotropy& isotropy) {
  return test::random_loop_in(Subspace(4, 8, isotropy), constant_loop(std::vector<double>(4, 0.0), 5.0, 8), 5);
}

std::vector<Isotropy> samples() {
  return {{element_of(galaxy(), "C", 1, 3), element_of(galaxy(), "R")},
          {element_of(galaxy(), "S", 1, 2), element_of(galaxy(), "RS")},
          {element_of(galaxy(), "RSC", 1, 4)},
          {}};
}

TEST(AffineSymmetry, IsFoundAsAboutTheOrigin) {
  for (const Isotropy& isotropy : samples()) {
    const Loop loop = sample(isotropy);
    const Isotropy expected = find_isotropy(galaxy(), loop, 1e-9);
    const Isotropy found = find_isotropy(moved().structure, there(loop), 1e-9);
    EXPECT_EQ(to_text(found), to_text(expected));
    for (const SymmetryElement& e : found) EXPECT_LT(symmetry_defect(there(loop), e, {}), 1e-12);
    // Without its offset a symmetry is none.
    for (SymmetryElement e : found) {
      e.map.offset.setZero();
      EXPECT_GT(symmetry_defect(there(loop), e, {}), 0.1);
    }
  }
}

TEST(AffineSymmetry, GroupsAndPerturbationsAreTheSame) {
  for (const Isotropy& isotropy : samples()) {
    const Isotropy found = find_isotropy(moved().structure, there(sample(isotropy)), 1e-9);
    const SymmetryGroup here(galaxy(), find_isotropy(galaxy(), sample(isotropy), 1e-9));
    const SymmetryGroup group(moved().structure, found);
    ASSERT_EQ(to_text(group.elements()), to_text(here.elements()));
    EXPECT_EQ(group.order(), here.order());
    EXPECT_EQ(Subspace(4, 8, found).size(), Subspace(4, 8, isotropy).size());
    for (std::size_t n = 0; n < group.elements().size(); ++n) {
      const Loop image = transformed(there(sample({})), group.elements()[n]);
      EXPECT_LT(mean_distance(image, there(transformed(sample({}), here.elements()[n]))), 1e-12);
      // A perturbation knows nothing of the place.
      EXPECT_LT(mean_distance(transformed_perturbation(sample({}), group.elements()[n]),
                              transformed_perturbation(sample({}), here.elements()[n])),
                1e-12);
    }
  }
}

TEST(AffineSymmetry, PhasesAreTheSame) {
  for (const Isotropy& isotropy : samples()) {
    const Loop loop = sample(isotropy);
    const Loop expected = in_standard_phase(galaxy(), loop, isotropy);
    const Isotropy found = find_isotropy(moved().structure, there(loop), 1e-9);
    EXPECT_LT(mean_distance(in_standard_phase(moved().structure, there(loop), found), there(expected)), 1e-12);
  }
}

TEST(AffineSymmetry, LoopsAreBroughtTogether) {
  const Loop loop = sample({});
  const SymmetryGroup space = SymmetryGroup::of_space(galaxy());
  for (const SymmetryElement& e : space.elements()) {
    const Loop to = transformed(loop, e.map, e.reversing, irrational);
    const Alignment found = align(moved().structure, there(loop), there(to));
    EXPECT_EQ(found.name, e.name);
    EXPECT_NEAR(found.shift, irrational, 1e-12);
    EXPECT_LT(found.distance, 1e-11);
    EXPECT_LT(mean_distance(aligned(there(loop), found), there(to)), 1e-11);
  }
  const SymmetryElement c = element_of(galaxy(), "C", 1, 3);
  const auto map = find_map(moved().structure, there(loop), there(transformed(loop, c)), 1e-9);
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(to_text({*map}), "C@1/3");
}

// A pendulum driven from one side: the mirror goes with half a turn of the drive's phase, which winds once a loop.
TEST(AffineSymmetry, OffsetsOfAnglesThatWind) {
  systems::Structure driven = test::structure_of(3);
  driven.angles = {0, 2};
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  const Eigen::Matrix3d reverse = Eigen::Vector3d(1, -1, -1).asDiagonal();
  driven.equivariances = {{"S", {mirror, Eigen::Vector3d(0, 0, pi)}}};
  driven.reversors = {{"R", {reverse, Eigen::Vector3d(0, 0, pi)}}};
  Loop loop = constant_loop(std::vector<double>{0.0, 0.0, 0.5 * pi}, 4.0, 8);
  loop.winding = {0.0, 0.0, 1.0};
  for (int k = 1; k <= 7; k += 2) {
    loop.cosine(k, 0) = 1.0 / k;
    loop.sine(k, 1) = -0.7 / k;
  }
  EXPECT_EQ(to_text(find_isotropy(driven, loop, 1e-12)), "S@1/2 R@0");
  // Hanging upwards on average it has the same symmetries, modulo whole turns.
  loop.cosine(0, 0) = pi;
  EXPECT_EQ(to_text(find_isotropy(driven, loop, 1e-12)), "S@1/2 R@0");
  loop.cosine(2, 0) = 0.1;
  EXPECT_EQ(to_text(find_isotropy(driven, loop, 1e-12)), "R@0");
  loop.cosine(0, 2) = 0.4;
  EXPECT_EQ(to_text(find_isotropy(driven, loop, 1e-12)), "");
}

}  // namespace
}  // namespace orbweaver::loop::affine_symmetry_test
