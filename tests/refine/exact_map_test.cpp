#include "orbweaver/refine/exact_map.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::refine::exact_map_test {
namespace {

using numerics::Extended;
using numerics::WorkingDigits;

Matrix<double> turn(double parts) {
  const double angle = 2.0 * std::numbers::pi / parts;
  Matrix<double> matrix(2, 2);
  matrix << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return matrix;
}

TEST(ExactMatrix, IsTheRotationThatWasMeant) {
  const WorkingDigits working(60);
  for (const int n : {3, 4, 5, 6, 7, 8, 10, 12}) {
    const Matrix<Extended> matrix = ExactMatrix(turn(n)).value<Extended>();
    Matrix<Extended> power = Matrix<Extended>::Identity(2, 2);
    for (int k = 0; k < n; ++k) power = (matrix * power).eval();
    const Matrix<Extended> off = power - Matrix<Extended>::Identity(2, 2);
    for (Eigen::Index i = 0; i < 4; ++i) EXPECT_LT(numerics::log10_abs(off(i)), -57.0) << n;
    EXPECT_LT((ExactMatrix(turn(n)).value<double>() - turn(n)).norm(), 1e-15) << n;
  }
}

// All of them products of reflections and turns by a third: what they come to in double is off by roundings.
TEST(ExactMatrix, KnowsTheGroupsOfTheRegisteredSystems) {
  const WorkingDigits working(60);
  for (const std::string& name : systems::system_names()) {
    const auto system = systems::make_system(name);
    const auto group = loop::SymmetryGroup::of_space(system->structure());
    for (const loop::SymmetryElement& element : group.elements()) {
      const Matrix<Extended> matrix = ExactMatrix(element.map.matrix).value<Extended>();
      const Matrix<Extended> off =
          matrix * matrix.transpose() - Matrix<Extended>::Identity(matrix.rows(), matrix.rows());
      for (Eigen::Index i = 0; i < off.size(); ++i)
        EXPECT_LT(numerics::log10_abs(off(i)), -58.0) << name << ' ' << element.name;
    }
  }
}

TEST(ExactMatrix, LeavesOtherNumbersAsTheyAre) {
  Matrix<double> matrix(1, 1);
  matrix << 0.123456789;
  EXPECT_EQ(ExactMatrix(matrix).value<double>()(0, 0), 0.123456789);
}

}  // namespace
}  // namespace orbweaver::refine::exact_map_test
