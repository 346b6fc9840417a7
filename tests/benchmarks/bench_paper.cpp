// The paper's optimiser (Rprop with linear extrapolation, sections III A and III E) against the default corrector: one
// step of 0.5 degrees along a family at the paper's K, tolerance and subspace.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "family_orbit.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::benchmarks {

namespace {

/// The predicted loop of a step from an orbit of the family, to be corrected orthogonally to the tangent.
struct Step {
  std::shared_ptr<const systems::System> system;
  loss::Unknowns unknowns;
  loop::Loop guess;
  Eigen::VectorXd tangent;
};

corrector::Result correct(const Step& step, corrector::Method method) {
  corrector::Options options;
  options.method = method;
  return corrector::correct(*step.system, step.guess, step.unknowns, loss::Slice(step.unknowns.size(), step.tangent),
                            options, step.tangent);
}

// The step from the orbit with this period; none where `cutoff` harmonics do not resolve it.
std::optional<Step> step_from(const FamilyOrbit& orbit, int cutoff) {
  Step step{
      orbit.system, {loop::Subspace(orbit.loop.dimension, cutoff, orbit.isotropy), {loss::Scalar::period()}}, {}, {}};
  step.guess = loop::with_cutoff(orbit.loop, cutoff);
  step.tangent = Eigen::VectorXd::Unit(step.unknowns.size(), step.unknowns.size() - 1);
  const corrector::Result here = correct(step, corrector::Method::nls);
  if (!here.converged()) return std::nullopt;
  step.tangent = here.flat_direction.value();
  const auto moved = [&](const Eigen::VectorXd& by) {
    return step.unknowns.moved(here.loop, {by.data(), static_cast<std::size_t>(by.size())});
  };
  const std::vector<double> before = loop::state_at(here.loop, 0.0);
  const std::vector<double> after = loop::state_at(moved(step.tangent), 0.0);
  const double change = std::hypot(after[0] - before[0], after[1] - before[1]);
  step.guess = moved(0.5 * std::numbers::pi / 180.0 / change * step.tangent);
  return correct(step, corrector::Method::nls).converged() ? std::optional(step) : std::nullopt;
}

// Far along the family, but not beyond what `cutoff` harmonics resolve.
const Step& step_at(Family family, int cutoff) {
  static std::map<std::pair<Family, int>, Step> known;
  const auto key = std::pair(family, cutoff);
  if (const auto found = known.find(key); found != known.end()) return found->second;
  const double first_period = start_of(family).start.base.period;
  for (double beyond = 0.3; beyond > 1e-4; beyond *= 0.7)
    if (const auto step = step_from(family_orbit(family, (1.0 + beyond) * first_period), cutoff))
      return known.emplace(key, *step).first->second;
  throw core::NumericalError("no orbit of the family is resolved by so few harmonics");
}

void correct_step(benchmark::State& state, corrector::Method method) {
  const int cutoff = static_cast<int>(state.range(1));
  const Step& step = step_at(static_cast<Family>(state.range(0)), cutoff);
  corrector::Result result;
  for (auto _ : state) {
    result = correct(step, method);
    benchmark::DoNotOptimize(result);
  }
  if (!result.converged()) state.SkipWithError(result.detail.c_str());
  state.counters["T"] = result.loop.period;
  state.counters["unknowns"] = step.unknowns.size();
  state.counters["epochs"] = result.iterations;
}

void step_by_paper(benchmark::State& s) { correct_step(s, corrector::Method::rprop_extrapolated); }
void step_by_default(benchmark::State& s) { correct_step(s, corrector::Method::automatic); }

BENCHMARK(step_by_paper)->ArgsProduct({{0, 1, 2, 3}, {16, 32}})->Unit(benchmark::kMicrosecond);
BENCHMARK(step_by_default)->ArgsProduct({{0, 1, 2, 3}, {16, 32}})->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace orbweaver::benchmarks
