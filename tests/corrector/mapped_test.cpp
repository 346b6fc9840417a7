// Correction of loops under a time map: the orbit of a given period is that of the loop under the identity.
#include <cmath>

#include <gtest/gtest.h>

#include "corrector/fixture.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::corrector::mapped_test {
namespace {

std::vector<loop::TimeMap> maps() { return {{1.6, {}}, {0.8, {}}, {1.2, {0.0, 0.0, 0.1, 0.0}}}; }

constexpr double period = 8.3;

struct PinnedPeriod {
  PinnedPeriod(std::string symmetries, const loop::TimeMap& map, int cutoff)
      : guess(loop::with_time_map(starting_loop(cutoff), map, cutoff)),
        unknowns{loop::Subspace(4, cutoff, chosen(symmetries)), {loss::Scalar::period()}} {
    const Eigen::VectorXd shift = test::to_vector(unknowns.time_shift_direction(guess));
    const bool phase = shift.norm() > 1e-8;
    conditions = Eigen::MatrixXd::Zero(unknowns.size(), phase ? 2 : 1);
    conditions(unknowns.size() - 1, 0) = 1.0;
    if (phase) conditions.col(1) = shift.normalized();
  }

  // An orbit of the family with another period.
  static loop::Loop starting_loop(int cutoff) {
    const test::Problem near(test::in_phase(), 0.3, 22);
    loop::Loop loop = loop::with_cutoff(near.correct(near.guess).loop, cutoff);
    EXPECT_GT(std::abs(loop.period - period), 0.02);
    loop.period = period;
    return loop;
  }
  [[nodiscard]] loop::Isotropy chosen(const std::string& symmetries) const {
    loop::Isotropy out;
    for (const loop::SymmetryElement& element : test::pendulum_isotropy(*system))
      if (symmetries.find(element.name) != std::string::npos) out.push_back(element);
    return out;
  }
  [[nodiscard]] Result correct(Method method) const {
    return corrector::correct(*system, guess, unknowns, loss::Slice(unknowns.size(), conditions), {.method = method},
                              Eigen::VectorXd(conditions.col(0)));
  }
  [[nodiscard]] double energy_of(const loop::Loop& loop) const {
    return system->conserved(0, loop::state_at(loop, 0.0));
  }

  std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  loop::Loop guess;
  loss::Unknowns unknowns;
  Eigen::MatrixXd conditions;
};

class MappedCorrection : public testing::TestWithParam<std::string> {};

TEST_P(MappedCorrection, FindsTheOrbitThatIsFoundWithoutAMap) {
  const PinnedPeriod even_problem("SR", {}, 40);
  const Result even = even_problem.correct(Method::nls);
  ASSERT_TRUE(even.converged()) << even.detail;
  const Result even_krylov = PinnedPeriod(GetParam(), {}, 62).correct(Method::newton_krylov);
  ASSERT_TRUE(even_krylov.converged()) << even_krylov.detail;
  ASSERT_GT(loop::rms_amplitude(even.loop), 0.3);
  for (const loop::TimeMap& map : maps()) {
    const PinnedPeriod problem(GetParam(), map, 62);
    const Result assembled = problem.correct(Method::nls);
    const Result krylov = problem.correct(Method::newton_krylov);
    ASSERT_TRUE(assembled.converged()) << assembled.detail;
    ASSERT_TRUE(krylov.converged()) << krylov.detail;
    EXPECT_EQ(krylov.loop.time_map, map);
    EXPECT_NEAR(krylov.loop.period, period, 1e-12);
    EXPECT_NEAR(problem.energy_of(krylov.loop), problem.energy_of(even.loop), 1e-11);
    EXPECT_LT(loop::mean_distance(krylov.loop, assembled.loop), 1e-11);
    ASSERT_TRUE(krylov.flat_direction && assembled.flat_direction);
    EXPECT_LT((*krylov.flat_direction - *assembled.flat_direction).norm(), 1e-8);
    // The box scheme is as good a preconditioner as without a map.
    EXPECT_LE(krylov.inner_iterations, even_krylov.inner_iterations + 3);
    if (GetParam().find('R') != std::string::npos) {  // elsewhere the phase condition fixes another phase
      EXPECT_LT(loop::mean_distance(krylov.loop, even.loop), 1e-11);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(NewtonKrylov, MappedCorrection, testing::Values("SR", "S", "R", ""),
                         [](const auto& tested) { return tested.param.empty() ? std::string("none") : tested.param; });

// Least squares with more equations than the cutoff alone would give.
TEST(MappedCorrection, TakesEveryNodeOfASharpPulse) {
  const PinnedPeriod problem("SR", {12.0, {}}, 22);
  ASSERT_GT(loop::nodes_for(problem.guess), loop::FourierGrid::nodes_for(22));
  EXPECT_NO_THROW(static_cast<void>(problem.correct(Method::brgn)));
}

// The box scheme's columns for T and the unfolding are those of the equations, half a cell on: it inverts them exactly.
TEST(MappedCorrection, BordersOfThePreconditionerFollowTheMap) {
  for (const loop::TimeMap& map : {loop::TimeMap{}, loop::TimeMap{1.6, {}}, loop::TimeMap{0.6, {}}}) {
    PinnedPeriod problem("S", map, 102);
    problem.guess = problem.correct(Method::nls).loop;
    const loop::Subspace image = problem.unknowns.subspace.image();
    const loss::Slice slice(problem.unknowns.size(), problem.conditions);
    equations::LoopEquations equations(*problem.system, problem.guess, problem.unknowns, image, slice);
    equations.factor(*problem.system, problem.guess);
    for (const int unknown : {problem.unknowns.size() - 1, problem.unknowns.size()}) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(equations.size(), unknown);
      Eigen::VectorXd image_of_unit(equations.size());
      equations.apply(unit, image_of_unit);
      Eigen::VectorXd back(equations.size());
      equations.precondition(image_of_unit, back);
      EXPECT_LT((back - unit).norm(), 1e-12) << map.kappa << ", unknown " << unknown;
    }
  }
}

TEST(MappedThreshold, IsThatOfTheCurve) {
  const auto system = systems::make_system("double_pendulum");
  loop::Loop even = loop::with_cutoff(test::linear_loop(test::down_up(), 0.3, 5), 60);
  for (const double tolerance : {1e-10, 1e-18}) {  // by speed, by rounding
    const loss::Linearization lin(*system, even, loss::Linearization::Order::jacobian);
    const double expected = acceptance_threshold(even, lin, tolerance);
    for (const loop::TimeMap& map : {loop::TimeMap{1.6, {}}, loop::TimeMap{1.0, {0.2, 0.1}}}) {
      const loop::Loop mapped = loop::with_time_map(even, map, 120);
      const loss::Linearization there(*system, mapped, loss::Linearization::Order::jacobian);
      EXPECT_NEAR(acceptance_threshold(mapped, there, tolerance), expected, 1e-12 * expected);
    }
  }
}

}  // namespace
}  // namespace orbweaver::corrector::mapped_test
