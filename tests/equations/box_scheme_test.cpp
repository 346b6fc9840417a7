#include "box_scheme.hpp"

#include <gtest/gtest.h>

#include "box_problem.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::equations::box_scheme_test {
namespace {

using Shape = test::BoxProblem::Shape;

void expect_solved(const Shape& shape, BoxScheme::Storage storage, double tolerance) {
  const test::BoxProblem problem(shape);
  const auto box = BoxScheme::of_dimension(shape.dimension, storage);
  problem.factor(*box);
  for (const bool transposed : {false, true})
    EXPECT_LT(problem.residual(*box, transposed), tolerance)
        << shape.dimension << " coordinates, " << shape.cells << " cells, " << shape.borders << " borders, "
        << (shape.closed ? "closed" : "ends") << (storage == BoxScheme::Storage::lanes ? ", lanes" : ", line")
        << (transposed ? ", transposed" : "");
}

TEST(BoxScheme, SolvesItsSystem) {
  for (const auto storage : {BoxScheme::Storage::line, BoxScheme::Storage::lanes})
    for (const bool closed : {false, true})
      for (const int dimension : {1, 2, 3, 4, 5, 6, 7, 8, 33})
        for (const int cells : {4, 8, 28})
          for (const int borders : {0, 1, 2, 5, BoxScheme::most_borders})
            if (dimension < 33 || cells == 8) expect_solved({dimension, cells, borders, closed}, storage, 1e-14);
}

TEST(BoxScheme, LoopsNeedNotFillLanes) {
  for (const int cells : {1, 2, 3, 37})
    for (const int dimension : {1, 4, 7}) expect_solved({dimension, cells, 2, true}, BoxScheme::Storage::line, 1e-14);
}

TEST(BoxScheme, IsStableWhereSolutionsGrowAndDecay) {
  for (const auto storage : {BoxScheme::Storage::line, BoxScheme::Storage::lanes})
    for (const bool closed : {false, true})
      for (const int dimension : {1, 2, 4, 6, 7})
        for (const double strength : {1.0, 3.0, 30.0}) {
          Shape shape{dimension, 80, 2, closed};
          shape.strength = strength;
          expect_solved(shape, storage, 1e-14);
        }
}

TEST(BoxScheme, FactorsAnew) {
  for (const auto storage : {BoxScheme::Storage::line, BoxScheme::Storage::lanes}) {
    const auto box = BoxScheme::of_dimension(4, storage);
    const test::BoxProblem large({4, 28, 2});
    const test::BoxProblem small({4, 8, 1, true});
    for (const test::BoxProblem* problem : {&large, &small, &large}) {
      problem->factor(*box);
      EXPECT_LT(problem->residual(*box, false), 1e-14);
      EXPECT_LT(problem->residual(*box, true), 1e-14);
    }
  }
}

TEST(BoxScheme, SingularSystemsAreRefused) {
  test::BoxProblem problem({2, 8, 1});
  problem.left.setZero();
  problem.right.setZero();
  for (const auto storage : {BoxScheme::Storage::line, BoxScheme::Storage::lanes})
    EXPECT_THROW(problem.factor(*BoxScheme::of_dimension(2, storage)), core::NumericalError);
}

TEST(BoxScheme, MisuseIsRefused) {
  const test::BoxProblem odd({2, 7, 1});
  EXPECT_THROW(odd.factor(*BoxScheme::of_dimension(2, BoxScheme::Storage::lanes)), core::MisuseError);
  const test::BoxProblem bordered({2, 8, BoxScheme::most_borders + 1});
  EXPECT_THROW(bordered.factor(*BoxScheme::of_dimension(2, BoxScheme::Storage::line)), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::equations::box_scheme_test
