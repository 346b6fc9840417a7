#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "corrector/fixture.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::corrector::methods_test {
namespace {

constexpr std::array all_methods = {Method::automatic, Method::collocation, Method::newton_krylov,
                                    Method::brgn,      Method::nls,         Method::ntr,
                                    Method::lmvm,      Method::rprop,       Method::rprop_extrapolated};

std::string test_name(const testing::TestParamInfo<Method>& tested) {
  std::string name(name_of(tested.param));
  std::erase(name, '-');
  return name;
}

/// The in-phase orbit whose first harmonic is about 0.3 rad: T = 8.2717554210.
const test::Problem& problem() {
  static const test::Problem made(test::in_phase(), 0.3, 22);
  return made;
}

const loop::Loop& reference() {
  static const loop::Loop orbit = problem().correct(problem().guess, {.tolerance = 1e-13}).loop;
  return orbit;
}

class EveryMethod : public testing::TestWithParam<Method> {};

// A loop with sqrt(loss) = rms lies within rms / sigma of the orbit, sigma the smallest singular value of J on the
// slice; the second order adds about 1e-8 of that here.
TEST_P(EveryMethod, FindsTheSameOrbitFromNoise) {
  ASSERT_NEAR(reference().period, 8.27175542100751, 1e-12);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const loop::Loop guess = problem().noisy(0.1, seed);
    ASSERT_GT(problem().distance(guess, reference()), 0.05) << "the noise is too small to test anything";
    const Result result = problem().correct(guess, {.method = GetParam()});
    ASSERT_TRUE(result.converged()) << "seed " << seed << ": " << result.detail;
    EXPECT_TRUE(result.detail.empty());
    EXPECT_NEAR(result.threshold, 1e-10 * loop::rms_speed(result.loop), 1e-20);
    EXPECT_LT(result.loss_rms, result.threshold);
    EXPECT_GT(result.iterations, 0);
    const double bound = problem().distance_bound(reference(), std::max(result.loss_rms, 1e-14));
    EXPECT_LT(problem().distance(result.loop, reference()), bound) << "seed " << seed;
    EXPECT_LT(result.newton_step, is_second_order(GetParam()) ? 1e-6 : 1.01 * bound) << "seed " << seed;
  }
}

TEST_P(EveryMethod, StepStaysOrthogonalToTheTangent) {
  const loop::Loop guess = problem().noisy(0.1, 11);
  const Result result = problem().correct(guess, {.method = GetParam()});
  ASSERT_TRUE(result.converged()) << result.detail;
  const Eigen::VectorXd step = test::to_vector(problem().unknowns.difference(guess, result.loop));
  EXPECT_GT(step.norm(), 0.05);
  EXPECT_LT(std::abs(step.dot(problem().normal)), 1e-14 * step.norm());
}

TEST_P(EveryMethod, SameBitsOnRepeat) {
  const loop::Loop guess = problem().noisy(0.1, 12);
  const Result first = problem().correct(guess, {.method = GetParam()});
  static_cast<void>(problem().correct(problem().noisy(0.05, 13), {.method = GetParam()}));
  const Result second = problem().correct(guess, {.method = GetParam()});
  EXPECT_EQ(first.loop.modes, second.loop.modes);
  EXPECT_EQ(first.loop.period, second.loop.period);
  EXPECT_EQ(first.iterations, second.iterations);
}

TEST_P(EveryMethod, LeavesAnOrbitAlone) {
  const Result result = problem().correct(reference(), {.method = GetParam()});
  ASSERT_TRUE(result.converged()) << result.detail;
  EXPECT_EQ(result.iterations, 0);
  EXPECT_LT(problem().distance(result.loop, reference()), 1e-13);
}

TEST_P(EveryMethod, GivesTheFlatDirectionIfAsked) {
  const Result with = problem().correct(problem().guess, {.method = GetParam()});
  ASSERT_TRUE(with.flat_direction.has_value());
  EXPECT_NEAR(with.flat_direction->norm(), 1.0, 1e-14);
  EXPECT_GT(with.flat_direction->dot(problem().normal), 0.9);
  const Result without =
      correct(*problem().system, problem().guess, problem().unknowns, problem().slice(), {.method = GetParam()});
  EXPECT_FALSE(without.flat_direction.has_value());
}

INSTANTIATE_TEST_SUITE_P(Corrector, EveryMethod, testing::ValuesIn(all_methods), test_name);

// The full Hessian is indefinite away from the orbit: a closer guess, the same orbit.
TEST(Corrector, FullCurvatureFindsTheSameOrbit) {
  for (const Method method : {Method::nls, Method::ntr}) {
    const Result result =
        problem().correct(problem().noisy(0.01, 21), {.method = method, .curvature = loss::Curvature::full});
    ASSERT_TRUE(result.converged()) << name_of(method) << ": " << result.detail;
    EXPECT_LT(problem().distance(result.loop, reference()), 1e-12) << name_of(method);
  }
}

class NewtonOrder : public testing::TestWithParam<Method> {};

// Quadratic: e_(n+1) <= C e_n^2 with one C, and the order from the last three errors above rounding is 2.
TEST_P(NewtonOrder, ErrorsSquare) {
  const test::Problem far(test::in_phase(), 0.8, 67);
  const loop::Loop guess = far.noisy(0.1, 5);
  const Result orbit = far.correct(far.guess, {.tolerance = 1e-13});
  ASSERT_TRUE(orbit.converged()) << orbit.detail;
  std::vector<double> errors = {far.distance(guess, orbit.loop)};
  for (int n = 1; errors.back() > 1e-6; ++n) {
    ASSERT_LT(n, 8) << "too slow to be quadratic";
    const Result partial = far.correct(guess, {.method = GetParam(), .tolerance = 1e-16, .max_iterations = n});
    ASSERT_FALSE(partial.converged()) << "a converged run would have been polished by one more step";
    EXPECT_EQ(partial.iterations, n);
    errors.push_back(far.distance(partial.loop, orbit.loop));
  }
  const std::size_t last = errors.size() - 1;
  ASSERT_GE(last, 3u);
  const double order = std::log(errors[last] / errors[last - 1]) / std::log(errors[last - 1] / errors[last - 2]);
  EXPECT_GT(order, 1.8) << errors[last - 2] << " " << errors[last - 1] << " " << errors[last];
  const Result next =
      far.correct(guess, {.method = GetParam(), .tolerance = 1e-16, .max_iterations = static_cast<int>(last) + 1});
  EXPECT_LT(far.distance(next.loop, orbit.loop), 10.0 * errors[last] * errors[last] + 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Corrector, NewtonOrder,
                         testing::Values(Method::newton_krylov, Method::brgn, Method::nls, Method::ntr), test_name);

TEST(Corrector, ExtrapolationSavesRpropIterations) {
  int plain = 0;
  int extrapolated = 0;
  for (unsigned seed = 31; seed <= 36; ++seed) {
    const loop::Loop guess = problem().noisy(0.1, seed);
    const Result a = problem().correct(guess, {.method = Method::rprop});
    const Result b = problem().correct(guess, {.method = Method::rprop_extrapolated});
    ASSERT_TRUE(a.converged() && b.converged()) << a.detail << b.detail;
    plain += a.iterations;
    extrapolated += b.iterations;
  }
  EXPECT_LT(extrapolated, 0.85 * plain) << plain << " without";
}

TEST(Corrector, NamesRoundTrip) {
  for (const Method method : all_methods) EXPECT_EQ(method_of(name_of(method)), method);
  EXPECT_EQ(name_of(Method::rprop_extrapolated), "rprop-extrapolated");
  for (const std::string wrong : {"newton", "", "NLS", "rprop_extrapolated", "nls "}) {
    try {
      static_cast<void>(method_of(wrong));
      ADD_FAILURE() << "accepted `" << wrong << "`";
    } catch (const core::InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("`" + wrong + "`"), std::string::npos) << message;
      for (const Method method : all_methods) EXPECT_NE(message.find(name_of(method)), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace orbweaver::corrector::methods_test
