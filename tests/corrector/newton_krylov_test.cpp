#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "corrector/fixture.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::corrector::newton_krylov_test {
namespace {

/// An in-phase loop corrected in the subspace of some of its symmetries; the time shift is held where the subspace has
/// it.
struct InSubspace {
  InSubspace(const std::string& symmetries, double amplitude, int cutoff)
      : guess(test::linear_loop(test::in_phase(), amplitude, cutoff)),
        unknowns{loop::Subspace(4, cutoff, chosen(symmetries)), {loss::Scalar::period()}} {
    const loop::Loop base = loop::constant_loop(std::vector<double>(4, 0.0), guess.period, cutoff);
    const Eigen::VectorXd normal = test::to_vector(unknowns.difference(base, guess)).normalized();
    const Eigen::VectorXd shift = test::to_vector(unknowns.time_shift_direction(guess));
    const bool phase = shift.norm() > 1e-8;
    conditions.resize(unknowns.size(), phase ? 2 : 1);
    conditions.col(0) = normal;
    if (phase) conditions.col(1) = shift.normalized();
  }

  /// "SR", "S", "R" or "".
  [[nodiscard]] loop::Isotropy chosen(const std::string& symmetries) const {
    loop::Isotropy out;
    for (const loop::SymmetryElement& element : test::pendulum_isotropy(*system))
      if (symmetries.find(element.name) != std::string::npos) out.push_back(element);
    EXPECT_EQ(out.size(), symmetries.size());
    return out;
  }

  [[nodiscard]] Result correct(const Options& options) const {
    return corrector::correct(*system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options,
                              Eigen::VectorXd(conditions.col(0)));
  }

  std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  loop::Loop guess;
  loss::Unknowns unknowns;
  Eigen::MatrixXd conditions;
};

class InSubspaces : public testing::TestWithParam<std::string> {};

TEST_P(InSubspaces, FindsTheOrbitAndTangentOfTheAssembledNewton) {
  const InSubspace problem(GetParam(), 0.3, 22);
  const Result assembled = problem.correct({.method = Method::nls});
  const Result krylov = problem.correct({.method = Method::newton_krylov});
  ASSERT_TRUE(assembled.converged()) << assembled.detail;
  ASSERT_TRUE(krylov.converged()) << krylov.detail;
  EXPECT_NEAR(krylov.loop.period, 8.27175542100751, 1e-11);
  EXPECT_NEAR(krylov.loop.period, assembled.loop.period, 1e-11);
  EXPECT_LT(loop::mean_distance(krylov.loop, assembled.loop), 1e-11);
  ASSERT_TRUE(krylov.flat_direction && assembled.flat_direction);
  EXPECT_LT((*krylov.flat_direction - *assembled.flat_direction).norm(), 1e-8);
  EXPECT_GT(krylov.inner_iterations, 0);
  EXPECT_EQ(assembled.inner_iterations, 0);
  const Eigen::VectorXd step = test::to_vector(problem.unknowns.difference(problem.guess, krylov.loop));
  EXPECT_LT((problem.conditions.transpose() * step).norm(), 1e-13 * step.norm());
}

INSTANTIATE_TEST_SUITE_P(NewtonKrylov, InSubspaces, testing::Values("SR", "S", "R", ""),
                         [](const auto& tested) { return tested.param.empty() ? std::string("none") : tested.param; });

// The box scheme keeps the number of inner iterations from growing with the number of harmonics.
TEST(NewtonKrylov, InnerIterationsDoNotGrowWithTheCutoff) {
  const Result coarse = InSubspace("SR", 0.3, 22).correct({.method = Method::newton_krylov});
  const Result fine = InSubspace("SR", 0.3, 262).correct({.method = Method::newton_krylov});
  ASSERT_TRUE(coarse.converged() && fine.converged()) << coarse.detail << fine.detail;
  EXPECT_NEAR(fine.loop.period, coarse.loop.period, 1e-11);
  EXPECT_LE(fine.inner_iterations, 1.5 * coarse.inner_iterations + 5);
}

TEST(NewtonKrylov, AutomaticTakesItForLargeProblems) {
  const InSubspace small("SR", 0.3, 22);
  const InSubspace large("SR", 0.3, 112);
  ASSERT_LT(small.unknowns.size(), Options{}.krylov_from);
  ASSERT_GE(large.unknowns.size(), Options{}.krylov_from);
  EXPECT_EQ(small.correct({}).inner_iterations, 0);
  EXPECT_GT(large.correct({}).inner_iterations, 0);
  EXPECT_GT(small.correct({.krylov_from = 1}).inner_iterations, 0);
  EXPECT_EQ(large.correct({.krylov_from = 100000}).inner_iterations, 0);
}

TEST(NewtonKrylov, RefusesAProblemThatIsNotSquare) {
  InSubspace problem("SR", 0.3, 22);
  problem.unknowns.scalars.clear();
  problem.conditions.conservativeResize(problem.unknowns.size(), Eigen::NoChange);
  EXPECT_THROW(static_cast<void>(problem.correct({.method = Method::newton_krylov})), core::InputError);
}

}  // namespace
}  // namespace orbweaver::corrector::newton_krylov_test
