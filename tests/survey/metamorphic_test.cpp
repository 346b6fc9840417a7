// The same system told otherwise has the same tree: in other coordinates, by other steps.
#include "survey/metamorphic.hpp"

namespace orbweaver::test::metamorphic_test {
namespace {

TEST_P(Metamorphic, InOtherCoordinates) {
  const auto plain = atlas("plain", {});
  const scene::Scene scene = scene_of(with(), with().turned);
  const auto other = atlas(comm, "turned", scene, turned(scene, with().turn));
  if (comm.is_root()) expect_same_tree(*plain, *other);
}

TEST_P(Metamorphic, ByOtherSteps) {
  const auto plain = atlas("plain", {});
  for (const std::string& step : {with().step, with().half, with().twice}) {
    SCOPED_TRACE(step);
    const auto other = atlas("steps", {"continuation.step=" + step});
    if (comm.is_root()) expect_same_tree(*plain, *other);
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, Metamorphic, testing::Range(std::size_t{0}, quick_cases), name_of_case);

}  // namespace
}  // namespace orbweaver::test::metamorphic_test
