// Smallest eigenpairs and singular triplets against K: of assembled matrices, and matrix-free with time and memory.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "family_orbit.hpp"
#include "memory.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"
#include "orbweaver/spectrum/loop_triplets.hpp"
#include "orbweaver/spectrum/singular_triplets.hpp"
#include "support/off_branch_triplets.hpp"

namespace orbweaver::benchmarks {

namespace {

struct Problem {
  loss::Linearization linearization;
  loss::Unknowns unknowns;
};

Problem problem_at(int k) {
  const FamilyOrbit& orbit = family_orbit(Family::in_phase, 9.0);
  const loop::Loop loop = loop::with_cutoff(orbit.loop, loop::allowed_cutoff_at_least(k));
  return {loss::Linearization(*orbit.system, loop, loss::Linearization::Order::jacobian),
          {loop::Subspace(loop.dimension, loop.cutoff, orbit.isotropy), {loss::Scalar::period()}}};
}

void assemble_hessian(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(loss::assemble_hessian(p.linearization, p.unknowns, loss::Curvature::gauss_newton));
  state.counters["unknowns"] = p.unknowns.size();
}

void two_smallest_eigenpairs(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  const core::Handle<Mat> h = loss::assemble_hessian(p.linearization, p.unknowns, loss::Curvature::gauss_newton);
  for (auto _ : state) benchmark::DoNotOptimize(spectrum::smallest_eigenpairs(h, {.count = 2}));
  state.counters["unknowns"] = p.unknowns.size();
}

void two_smallest_singular_triplets(benchmark::State& state) {
  const Problem p = problem_at(static_cast<int>(state.range(0)));
  const core::Handle<Mat> j = loss::assemble_jacobian(p.linearization, p.unknowns);
  for (auto _ : state) benchmark::DoNotOptimize(spectrum::smallest_singular_triplets(j, 2));
  state.counters["unknowns"] = p.unknowns.size();
}

/// An orbit of a family, padded to K harmonics, in one subspace; the family's tangent and the phase are held.
struct OnFamily {
  OnFamily(Family family, double period, int k, bool symmetric)
      : orbit(family_orbit(family, period)),
        loop(loop::with_cutoff(orbit.loop, std::max(orbit.loop.cutoff, loop::allowed_cutoff_at_least(k)))),
        isotropy(symmetric ? orbit.isotropy : loop::Isotropy{}),
        unknowns{loop::Subspace(loop.dimension, loop.cutoff, isotropy), {loss::Scalar::period()}} {
    conditions = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
    const std::vector<double> shift = unknowns.time_shift_direction(loop);
    if (!symmetric) {
      conditions.conservativeResize(Eigen::NoChange, 2);
      conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size()).normalized();
    }
    conditions.col(0) = corrected(loop).flat_direction.value();
  }
  [[nodiscard]] corrector::Result corrected(const loop::Loop& guess) const {
    corrector::Options options;
    options.method = corrector::Method::newton_krylov;
    corrector::Result result =
        corrector::correct(*orbit.system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options,
                           Eigen::VectorXd(conditions.col(0)));
    if (!result.converged()) throw core::NumericalError(result.detail);
    return result;
  }
  [[nodiscard]] std::vector<continuation::OffBranchTriplet> triplets(const corrector::Result& at) const {
    const Eigen::VectorXd& t = at.flat_direction.value();
    const loop::Tangent tangent = unknowns.tangent_of(std::span(t.data(), static_cast<std::size_t>(t.size())));
    spectrum::TripletOptions options;
    options.count = 2;
    options.krylov_from = 1;
    return test::off_branch_triplets(*orbit.system, at.loop, isotropy, tangent, options);
  }

  const FamilyOrbit& orbit;
  loop::Loop loop;
  loop::Isotropy isotropy;
  loss::Unknowns unknowns;
  Eigen::MatrixXd conditions;
};

void report(benchmark::State& state, const OnFamily& problem, double peak,
            const std::vector<continuation::OffBranchTriplet>& triplets) {
  state.counters["K"] = problem.loop.cutoff;
  state.counters["unknowns"] = problem.unknowns.size();
  state.counters["MiB"] = peak;
  state.counters["sigma1"] = triplets.at(0).singular_value;
  state.counters["sigma2"] = triplets.at(1).singular_value;
  double residual = 0.0;
  for (const auto& t : triplets) residual = std::max({residual, t.residual, t.left_residual});
  state.counters["residual"] = residual;
  state.SetComplexityN(problem.loop.cutoff);
}

/// The two smallest off-branch triplets, sector by sector (all four) or over the whole space at once.
void off_branch(benchmark::State& state, double period, bool symmetric) {
  const OnFamily problem(Family::in_phase, period, static_cast<int>(state.range(0)), symmetric);
  const corrector::Result at = problem.corrected(problem.loop);
  std::vector<continuation::OffBranchTriplet> found;
  const double peak = peak_memory_of([&] { found = problem.triplets(at); });
  for (auto _ : state) found = problem.triplets(at);
  report(state, problem, peak, found);
}

/// One continuation step of a family, full loop: prediction, correction with its tangent, the two smallest off-branch
/// triplets.
void step_with_triplets(benchmark::State& state, Family family, double period) {
  const OnFamily problem(family, period, static_cast<int>(state.range(0)), false);
  const Eigen::VectorXd prediction = 0.02 * problem.conditions.col(0);
  std::vector<continuation::OffBranchTriplet> found;
  int iterations = 0;
  const auto step = [&] {
    const corrector::Result at = problem.corrected(problem.unknowns.moved(
        problem.loop, std::span(prediction.data(), static_cast<std::size_t>(prediction.size()))));
    iterations = at.iterations + 1;
    found = problem.triplets(at);
  };
  const double peak = peak_memory_of(step);
  for (auto _ : state) step();
  report(state, problem, peak, found);
  state.counters["newton"] = iterations;
}

void off_branch_full_short(benchmark::State& s) { off_branch(s, 8.25, false); }
void off_branch_full(benchmark::State& s) { off_branch(s, 12.0, false); }
void off_branch_sectors_short(benchmark::State& s) { off_branch(s, 8.25, true); }
void off_branch_sectors(benchmark::State& s) { off_branch(s, 12.0, true); }
void step_with_triplets_T12(benchmark::State& s) { step_with_triplets(s, Family::in_phase, 12.0); }
void step_with_triplets_T20(benchmark::State& s) { step_with_triplets(s, Family::in_phase, 20.0); }
void step_with_triplets_T30(benchmark::State& s) { step_with_triplets(s, Family::in_phase, 30.0); }
void step_with_triplets_out_phase_T25(benchmark::State& s) { step_with_triplets(s, Family::out_phase, 25.0); }

BENCHMARK(off_branch_full_short)->RangeMultiplier(2)->Range(32, 256)->Unit(benchmark::kMillisecond);
BENCHMARK(off_branch_full)->RangeMultiplier(2)->Range(256, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(off_branch_sectors_short)->RangeMultiplier(2)->Range(32, 256)->Unit(benchmark::kMillisecond);
BENCHMARK(off_branch_sectors)->RangeMultiplier(2)->Range(256, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(step_with_triplets_T12)->Arg(1012)->Unit(benchmark::kMillisecond);
BENCHMARK(step_with_triplets_T20)->Arg(1012)->Unit(benchmark::kMillisecond);
BENCHMARK(step_with_triplets_T30)->Arg(1012)->Unit(benchmark::kMillisecond);
BENCHMARK(step_with_triplets_out_phase_T25)->Arg(1012)->Unit(benchmark::kMillisecond);
BENCHMARK(assemble_hessian)->RangeMultiplier(2)->Range(64, 1024)->Unit(benchmark::kMicrosecond);
BENCHMARK(two_smallest_eigenpairs)->RangeMultiplier(2)->Range(16, 512)->Unit(benchmark::kMicrosecond);
BENCHMARK(two_smallest_singular_triplets)->RangeMultiplier(2)->Range(16, 128)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace orbweaver::benchmarks
