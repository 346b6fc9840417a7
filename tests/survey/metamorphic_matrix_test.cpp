// The same tree by other first steps, tolerances and numbers of ranks, and in other units.
#include <tuple>

#include "survey/metamorphic.hpp"

namespace orbweaver::test::metamorphic_matrix_test {
namespace {

class MetamorphicMatrix : public Metamorphic {};

TEST_P(MetamorphicMatrix, ByOtherFirstSteps) {
  const auto plain = atlas("plain", {});
  for (const std::string& first : with().first) {
    SCOPED_TRACE(first);
    const auto other = atlas("first", {"continuation.start=" + first});
    if (comm.is_root()) expect_same_tree(*plain, *other);
  }
}

TEST_P(MetamorphicMatrix, WithOtherTolerances) {
  const auto plain = atlas("plain", {});
  for (const std::string tolerance : {"1e-8", "1e-9", "1e-11", "1e-12"}) {
    SCOPED_TRACE(tolerance);
    const auto other = atlas("tolerance", {"continuation.tolerance=" + tolerance});
    if (comm.is_root()) expect_same_tree(*plain, *other);
  }
}

TEST_P(MetamorphicMatrix, OnOneRank) {
  const auto all = atlas("all", {});
  if (!comm.is_root()) return;
  const core::Communicator alone(MPI_COMM_SELF);
  expect_same_tree(*atlas(alone, "alone", scene_of(with(), {})), *all);
}

TEST_P(MetamorphicMatrix, InOtherUnits) {
  const auto plain = atlas("plain", {});
  for (const auto& [length, time, mass] : {std::tuple(1e3, 1e-3, 1.0), {1e-6, 1e6, 1e6}, {1e6, 1e-6, 1e-6}}) {
    SCOPED_TRACE(fmt::format("length {} time {} mass {}", length, time, mass));
    const double energy = mass * length * length / (time * time);
    const scene::Scene scene = scene_of(with(), with().in_units(length, time, energy));
    Eigen::VectorXd units(4);
    units << length, length, length / time, length / time;
    if (scene.system.name == "double_pendulum") units << 1.0, 1.0, 1.0 / time, 1.0 / time;
    const auto other = atlas(comm, "units", scene, turned(scene, units.asDiagonal().toDenseMatrix(), time, energy));
    if (comm.is_root()) expect_same_tree(*plain, *other, time, energy);
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, MetamorphicMatrix, testing::Range(std::size_t{0}, cases().size()), name_of_case);

}  // namespace
}  // namespace orbweaver::test::metamorphic_matrix_test
