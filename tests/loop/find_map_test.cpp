#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::find_map_test {
namespace {

using test::element_of;

constexpr double tolerance = 1e-9;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }

Loop sample() { return test::random_loop(4, 6, 51); }

void expect_map(const Loop& from, const Loop& to, const std::string& text) {
  const auto map = find_map(pendulum(), from, to, tolerance);
  ASSERT_TRUE(map.has_value()) << text;
  EXPECT_EQ(to_text({*map}), text);
  Loop image = transformed(from, *map);
  for (const int i : pendulum().angles)
    image.cosine(0, i) -= test::two_pi * std::round((image.cosine(0, i) - to.cosine(0, i)) / test::two_pi);
  EXPECT_LT(mean_distance(image, to), tolerance);
}

TEST(FindMap, SeesTheSameLoop) { expect_map(sample(), sample(), "1@0"); }

TEST(FindMap, SeesTimeShifts) {
  expect_map(sample(), time_shifted(sample(), 0.5), "1@1/2");
  expect_map(sample(), time_shifted(sample(), 0.75), "1@3/4");
}

TEST(FindMap, SeesReversors) {
  expect_map(sample(), transformed(sample(), element_of(pendulum(), "R")), "R@0");
  expect_map(sample(), transformed(sample(), element_of(pendulum(), "RS", 1, 4)), "RS@1/4");
}

TEST(FindMap, SeesMirrorImages) {
  expect_map(sample(), transformed(sample(), element_of(pendulum(), "S")), "S@0");
  expect_map(sample(), transformed(sample(), element_of(pendulum(), "S", 2, 3)), "S@2/3");
}

TEST(FindMap, ActsModuloTheLatticeOfAngles) {
  Loop mirrored = transformed(sample(), element_of(pendulum(), "S"));
  mirrored.cosine(0, 0) += test::two_pi;
  mirrored.cosine(0, 1) -= 3.0 * test::two_pi;
  expect_map(sample(), mirrored, "S@0");
}

TEST(FindMap, MapsRotationsToTheOtherWayRound) {
  Loop rotation = sample();
  rotation.winding = {1.0, 0.0, 0.0, 0.0};
  expect_map(rotation, transformed(rotation, element_of(pendulum(), "S", 1, 2)), "S@1/2");
  expect_map(rotation, transformed(rotation, element_of(pendulum(), "R")), "R@0");
}

TEST(FindMap, LetsTheCutoffsDiffer) { expect_map(sample(), with_cutoff(time_shifted(sample(), 0.5), 11), "1@1/2"); }

TEST(FindMap, FindsNoneWhereThereIsNone) {
  EXPECT_FALSE(find_map(pendulum(), sample(), test::random_loop(4, 6, 52), tolerance).has_value());
  EXPECT_FALSE(find_map(pendulum(), sample(), time_shifted(sample(), 0.2), tolerance).has_value())
      << "a fifth is beyond fourths";
  EXPECT_TRUE(find_map(pendulum(), sample(), time_shifted(sample(), 0.2), tolerance, 5).has_value());
  Loop winding = sample();
  winding.winding = {2.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(find_map(pendulum(), sample(), winding, tolerance).has_value());
  Loop nearly = sample();
  nearly.cosine(1, 2) += 1e-3;
  EXPECT_FALSE(find_map(pendulum(), sample(), nearly, tolerance).has_value());
  EXPECT_TRUE(find_map(pendulum(), sample(), nearly, 1e-2).has_value());
}

}  // namespace
}  // namespace orbweaver::loop::find_map_test
