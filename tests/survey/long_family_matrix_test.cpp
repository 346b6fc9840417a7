// The end of the long-period family at mu = 0.001 hangs neither on the tolerance nor on the first step.
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "survey/long_family.hpp"

namespace long_family_matrix_test {
namespace {

using namespace orbweaver;

class LongFamilyMatrix : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(LongFamilyMatrix, EndsAtItsResonance) {
  const core::Communicator comm;
  test::expect_long_family_to_end(comm, {.tolerance = std::get<0>(GetParam()), .first = std::get<1>(GetParam())});
}

INSTANTIATE_TEST_SUITE_P(ByToleranceAndFirstStep, LongFamilyMatrix,
                         testing::Combine(testing::Values("1e-8", "1e-9", "1e-10", "1e-11"),
                                          testing::Values("0.0017", "0.0052", "0.0087", "0.0122", "0.0175")));

// With a limit that a step over the gap would meet; and with the tolerance and first step at which orbits that were
// solved to the tolerance only were so far beside the family that the next step left it.
TEST(LongFamily, EndsAtItsResonance) {
  const core::Communicator comm;
  test::expect_long_family_to_end(comm, {.limit = "83"});
  test::expect_long_family_to_end(comm, {.tolerance = "1e-8"});
}

}  // namespace
}  // namespace long_family_matrix_test
