#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "corrector/fixture.hpp"
#include "corrector/oscillator.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::corrector::outcomes_test {
namespace {

using testing::HasSubstr;

constexpr std::array all_methods = {Method::automatic, Method::collocation, Method::newton_krylov,
                                    Method::brgn,      Method::nls,         Method::ntr,
                                    Method::lmvm,      Method::rprop,       Method::rprop_extrapolated};

/// q = cos s, p = -sin s with a wrong period, amplitude held.
struct CircleGuess {
  CircleGuess(const systems::System& of, double period_in_turns)
      : system(of),
        guess(circle(period_in_turns)),
        unknowns{loop::Subspace(2, 10, isotropy()), {loss::Scalar::period()}},
        normal(amplitude()) {}

  static loop::Loop circle(double period_in_turns) {
    loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 1.0, 10);
    loop.period = 2.0 * std::numbers::pi * period_in_turns;
    loop.cosine(1, 0) = 1.0;
    loop.sine(1, 1) = -1.0;
    return loop;
  }
  [[nodiscard]] loop::Isotropy isotropy() const { return loop::find_isotropy(system.structure(), circle(1.0), 1e-9); }
  [[nodiscard]] Eigen::VectorXd amplitude() const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(unknowns.size());
    unknowns.subspace.project(guess.modes, std::span(out.data(), static_cast<std::size_t>(unknowns.subspace.size())));
    return out.normalized();
  }
  [[nodiscard]] Result correct(const Options& options) const {
    return corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), normal), options, normal);
  }

  const systems::System& system;
  loop::Loop guess;
  loss::Unknowns unknowns;
  Eigen::VectorXd normal;
};

/// Whatever went wrong: a sentence, no flat direction, the loop still there.
void expect_outcome(const Result& result, Outcome wanted) {
  EXPECT_EQ(result.outcome, wanted) << name_of(result.outcome) << ": " << result.detail;
  EXPECT_FALSE(result.converged());
  EXPECT_FALSE(result.detail.empty());
  EXPECT_FALSE(result.flat_direction.has_value());
  EXPECT_FALSE(result.loop.modes.empty());
}

TEST(Outcomes, UnderResolvedWithTooFewHarmonics) {
  const test::Problem problem(test::in_phase(), 0.6, 10);  // needs K = 40
  for (const Method method : {Method::newton_krylov, Method::brgn, Method::nls, Method::ntr}) {
    const Result result = problem.correct(problem.guess, {.method = method});
    expect_outcome(result, Outcome::under_resolved);
    EXPECT_THAT(result.detail, HasSubstr("K = 10"));
    EXPECT_GT(result.loss_rms, result.threshold);
  }
}

TEST(Outcomes, ATailOfRoundingAsksForNoHarmonics) {
  const test::Problem problem(test::in_phase(), 0.6, 87);  // resolved at K = 40
  for (const Method method : {Method::newton_krylov, Method::nls}) {
    const Result result = problem.correct(problem.guess, {.method = method, .tolerance = 1e-18});
    EXPECT_TRUE(result.converged()) << name_of(method) << ": " << result.detail;
    EXPECT_TRUE(result.at_rounding);
    EXPECT_GT(result.loss_rms, result.threshold);
    EXPECT_LT(result.loss_rms, 1e-13);
  }
  const test::Problem coarse(test::in_phase(), 0.6, 10);
  EXPECT_FALSE(coarse.correct(coarse.guess, {.method = Method::nls}).at_rounding);
}

class EveryMethodFails : public testing::TestWithParam<Method> {};

TEST_P(EveryMethodFails, NotFinite) {
  const test::Oscillator walled(0.0, 0.9);
  const Result result = CircleGuess(walled, 1.0).correct({.method = GetParam()});
  expect_outcome(result, Outcome::not_finite);
  EXPECT_THAT(result.detail, HasSubstr("test_oscillator"));
  EXPECT_THAT(result.detail, HasSubstr("state (1, 0)"));
}

TEST_P(EveryMethodFails, PeriodNotPositiveInTheGuess) {
  const test::Oscillator oscillator(0.0);
  for (const double turns : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    const Result result = CircleGuess(oscillator, turns).correct({.method = GetParam()});
    expect_outcome(result, Outcome::period_not_positive);
    EXPECT_THAT(result.detail, HasSubstr("period"));
  }
}

TEST_P(EveryMethodFails, IterationLimit) {
  const test::Oscillator oscillator(0.0);
  const Result result = CircleGuess(oscillator, 1.2).correct({.method = GetParam(), .max_iterations = 2});
  expect_outcome(result, Outcome::iteration_limit);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_THAT(result.detail, HasSubstr("2 iterations"));
}

// With damping no loop of amplitude 1 is an orbit: the loss has a minimum above zero, and more harmonics do not help.
TEST_P(EveryMethodFails, StalledWhereThereIsNoOrbit) {
  const test::Oscillator damped(0.3);
  const Result result =
      CircleGuess(damped, 1.2).correct({.method = GetParam(), .max_iterations = is_second_order(GetParam()) ? 0 : 500});
  expect_outcome(result, is_second_order(GetParam()) ? Outcome::stalled : Outcome::iteration_limit);
  EXPECT_NEAR(result.loss_rms, 0.211, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Outcomes, EveryMethodFails, testing::ValuesIn(all_methods), [](const auto& tested) {
  std::string name(name_of(tested.param));
  std::erase(name, '-');
  return name;
});

// Three times the true period: the full Gauss-Newton step leads to T = -3. BRGN takes it (and says so), the others
// search.
TEST(Outcomes, PeriodNotPositiveOnTheWay) {
  const test::Oscillator oscillator(0.0);
  expect_outcome(CircleGuess(oscillator, 3.0).correct({.method = Method::brgn}), Outcome::period_not_positive);
  for (const Method method : {Method::nls, Method::ntr}) {
    const Result result = CircleGuess(oscillator, 3.0).correct({.method = method});
    ASSERT_TRUE(result.converged()) << name_of(method) << ": " << result.detail;
    EXPECT_NEAR(result.loop.period, 2.0 * std::numbers::pi, 1e-12);
  }
}

// Under its threshold, but far from the orbit: a coarse tolerance does not pass a loop whose Newton step is not small.
TEST(Outcomes, StalledWithALargeNewtonStep) {
  const test::Problem problem(test::in_phase(), 0.3, 22);
  const Result result = problem.correct(problem.noisy(0.1, 3), {.method = Method::rprop, .tolerance = 1e-4});
  EXPECT_EQ(result.outcome, Outcome::stalled);
  EXPECT_LT(result.loss_rms, result.threshold);
  EXPECT_GT(result.newton_step, 1e-5);
  EXPECT_THAT(result.detail, HasSubstr("Newton step"));
}

TEST(Outcomes, MisuseThrows) {
  const test::Problem problem(test::in_phase(), 0.3, 22);
  const loss::Slice other(problem.unknowns.size() + 1, Eigen::VectorXd::Ones(problem.unknowns.size() + 1));
  EXPECT_THROW(static_cast<void>(correct(*problem.system, problem.guess, problem.unknowns, other, {})),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(problem.correct(loop::with_cutoff(problem.guess, 10))), core::MisuseError);
}

TEST(Outcomes, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (int n = 0; n <= static_cast<int>(Outcome::solver_failed); ++n) names.insert(name_of(static_cast<Outcome>(n)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Outcome::solver_failed) + 1);
  EXPECT_EQ(names.count("unknown"), 0u);
}

}  // namespace
}  // namespace orbweaver::corrector::outcomes_test
