// Guesses 30 % off in the period and all modes: what is said to be an orbit is one, and the nearest of the slice.
#include <cmath>
#include <numbers>

#include "continuation/families.hpp"
#include "corrector/fixture.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"

namespace guesses_test {
namespace {

using namespace orbweaver;

double closure_of(const loop::Loop& loop) {
  const auto start = test::reference::point_of<4>(loop::state_at(loop, 0.0));
  const auto end = test::reference::flow(test::reference::DoublePendulum{}, start, loop.period);
  return static_cast<double>(test::reference::distance(start, end));
}

class Guesses : public testing::TestWithParam<test::PendulumMode> {};

TEST_P(Guesses, ThirtyPercentOff) {
  constexpr int seeds = 20;
  const test::Problem problem(GetParam(), 0.3, 87);
  const std::string name = GetParam().name + ", 20 guesses 30 % off, four methods";
  const loop::Loop orbit = problem.correct(problem.guess).loop;
  test::HardCase row(name, "those that converge close by extrapolation");
  double worst = 0.0;
  int tried = 0;
  int converged = 0;
  int same = 0;
  int silent = 0;
  for (const auto method :
       {corrector::Method::newton_krylov, corrector::Method::nls, corrector::Method::ntr, corrector::Method::brgn})
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const corrector::Result result = problem.correct(problem.noisy(0.3, seed), {.method = method});
      ++tried;
      if (!result.converged()) {
        silent += result.detail.empty() ? 1 : 0;
        continue;
      }
      ++converged;
      worst = test::worse(worst, closure_of(result.loop));
      same += problem.distance(result.loop, orbit) < 1e-8 ? 1 : 0;
    }
  row.within(worst, 1e-9);
  test::HardCase(name, "to the slice's orbit, or to a sentence that says why not")
      .is(2 * converged > tried && same == converged && silent == 0, "most, and none elsewhere",
          fmt::format("{} of {}, {} to it", converged, tried, same));
}

INSTANTIATE_TEST_SUITE_P(Hard, Guesses, testing::ValuesIn(test::pendulum_modes()));

}  // namespace
}  // namespace guesses_test
