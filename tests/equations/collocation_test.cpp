#include "orbweaver/equations/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/equations/orbit_solver.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/systems/system.hpp"
#include "support/oscillator_chain.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::equations::collocation_test {
namespace {

const systems::System& pendulum() {
  static const auto system = systems::make_system("double_pendulum");
  return *system;
}

struct Case {
  std::string name;
  bool shift;
  bool reversor;
  double kappa;
};

class Equations : public testing::TestWithParam<Case> {
 protected:
  static constexpr int cells = 24;
  loop::Isotropy isotropy = [this] {
    loop::Isotropy out;
    if (GetParam().shift) out.push_back(test::element_of(pendulum().structure(), "S", 1, 2));
    if (GetParam().reversor) out.push_back(test::element_of(pendulum().structure(), "R"));
    return out;
  }();
  loop::TimeMap map{GetParam().kappa, {}};
  Collocation equations{pendulum(),
                        loop::fundamental_domain(pendulum().structure(), isotropy),
                        std::vector<double>(4, 0.0),
                        std::vector<double>(4, 0.0),
                        cells,
                        map};

  /// A loop with the symmetries, near nothing in particular.
  [[nodiscard]] loop::Loop sample() const {
    loop::Loop base = loop::constant_loop(std::vector<double>(4, 0.0), 7.0, equations.grid().cutoff() - 1);
    base = test::random_loop_in(loop::Subspace(4, base.cutoff, isotropy), base, 5, 0.4);
    base.time_map = map;
    return base;
  }
  [[nodiscard]] std::vector<double> point_of(const loop::Loop& loop) const {
    std::vector<double> u(static_cast<std::size_t>(equations.size()), 0.0);
    equations.from_loop(loop, u.data());
    return u;
  }
  /// What fills the strides is no unknown.
  [[nodiscard]] std::vector<double> random_unknowns() const {
    std::vector<double> v = test::random_values(static_cast<std::size_t>(equations.size()), 11);
    for (int i = 0; i < equations.dimension(); ++i)
      for (int j = equations.cells() + 1; j < equations.grid().stride(); ++j)
        v[static_cast<std::size_t>(i * equations.grid().stride() + j)] = 0.0;
    return v;
  }
  void set_random_conditions(const std::vector<double>& reference) {
    equations.set_conditions(test::random_values(static_cast<std::size_t>(equations.borders() * equations.size()), 9),
                             reference);
  }
};

TEST_P(Equations, JacobianIsTheDerivativeOfTheResidual) {
  const std::vector<double> u = point_of(sample());
  set_random_conditions(u);
  equations.factor(u.data());
  const std::vector<double> v = test::random_values(u.size(), 11);
  std::vector<double> derivative(u.size());
  equations.apply_jacobian(v.data(), derivative.data());
  const double h = 1e-6;
  std::vector<double> plus = u;
  std::vector<double> minus = u;
  for (std::size_t n = 0; n < u.size(); ++n) {
    plus[n] += h * v[n];
    minus[n] -= h * v[n];
  }
  std::vector<double> above(u.size());
  std::vector<double> below(u.size());
  equations.residual(plus.data(), above.data());
  equations.residual(minus.data(), below.data());
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_NEAR(derivative[n], (above[n] - below[n]) / (2.0 * h), 2e-8) << n;
}

// The box scheme has the same differences and the same borders, and meets the ends exactly.
TEST_P(Equations, PreconditionerSolvesWhatDoesNotDependOnTheStates) {
  const std::vector<double> u = point_of(sample());
  set_random_conditions(u);
  equations.factor(u.data());
  std::vector<double> v(u.size(), 0.0);
  v[static_cast<std::size_t>(equations.period_at())] = 1.0;
  std::vector<double> r(u.size());
  equations.apply_jacobian(v.data(), r.data());
  equations.precondition(r.data());
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_NEAR(r[n], v[n], 1e-10) << n;
}

TEST_P(Equations, TheDerivativeItselfIsItsOwnPreconditioner) {
  const std::vector<double> u = point_of(sample());
  set_random_conditions(u);
  equations.precondition_by(Preconditioner::exact);
  equations.factor(u.data());
  const std::vector<double> v = random_unknowns();
  std::vector<double> r(u.size());
  equations.apply_jacobian(v.data(), r.data());
  equations.precondition(r.data());
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_NEAR(r[n], v[n], 1e-9) << n;
  // The box scheme again from the next factor on.
  equations.precondition_by(Preconditioner::box);
  equations.factor(u.data());
  equations.apply_jacobian(v.data(), r.data());
  equations.precondition(r.data());
  double apart = 0.0;
  for (std::size_t n = 0; n < u.size(); ++n) apart = std::max(apart, std::abs(r[n] - v[n]));
  EXPECT_GT(apart, 1e-3);
}

TEST_P(Equations, GmresAroundTheBoxInvertsTheDerivative) {
  const std::vector<double> u = point_of(sample());
  set_random_conditions(u);
  equations.precondition_by(Preconditioner::krylov);
  equations.factor(u.data());
  const std::vector<double> v = random_unknowns();
  std::vector<double> r(u.size());
  equations.apply_jacobian(v.data(), r.data());
  equations.precondition(r.data());
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_NEAR(r[n], v[n], 1e-7) << n;
}

// A relative change of all that is rounded changes the residual by as much as is said of rounding, or less, as signs
// differ.
TEST_P(Equations, RoundingOfTheResidualIsThatOfTheStates) {
  const std::vector<double> u = point_of(sample());
  set_random_conditions(u);
  equations.factor(u.data());
  const std::vector<double> signs = test::random_values(u.size(), 12);
  std::vector<double> moved = u;
  const double relative = 1e-7;
  for (int n = 0; n < equations.period_at(); ++n) {
    const auto at = static_cast<std::size_t>(n);
    moved[at] *= 1.0 + std::copysign(relative, signs[at]);
  }
  std::vector<double> before(u.size());
  std::vector<double> after(u.size());
  equations.residual(u.data(), before.data());
  equations.residual(moved.data(), after.data());
  double square = 0.0;
  for (int n = 0; n < equations.period_at(); ++n) {
    const auto at = static_cast<std::size_t>(n);
    square += std::pow((after[at] - before[at]) / relative, 2);
  }
  const double rounding = equations.residual_rounding(u.data()) / std::numeric_limits<double>::epsilon();
  EXPECT_LT(std::sqrt(square), 2.0 * rounding);
  EXPECT_GT(std::sqrt(square), 0.1 * rounding);
}

// A chain of any number of particles: no dimension is left out.
TEST(Collocation, AppliesToAnyDimension) {
  for (const int particles : {1, 4, 5, 7}) {
    const test::OscillatorChain chain(particles);
    const int d = chain.dimension();
    loop::Isotropy isotropy{test::element_of(chain.structure(), "S", 1, 2),
                            test::element_of(chain.structure(), "R")};
    const loop::FundamentalDomain domain = loop::fundamental_domain(chain.structure(), isotropy);
    ASSERT_TRUE(Collocation::applies(chain, domain)) << d;
    const std::vector<double> zero(static_cast<std::size_t>(d), 0.0);
    Collocation equations(chain, domain, zero, zero, 16, {});
    loop::Loop loop = loop::constant_loop(zero, 5.0, equations.grid().cutoff() - 1);
    loop = test::random_loop_in(loop::Subspace(d, loop.cutoff, isotropy), loop, 5, 0.4);
    std::vector<double> u(static_cast<std::size_t>(equations.size()));
    equations.from_loop(loop, u.data());
    equations.set_conditions(test::random_values(u.size(), 9), u);
    equations.factor(u.data());
    std::vector<double> v(u.size(), 0.0);
    v[static_cast<std::size_t>(equations.period_at())] = 1.0;
    std::vector<double> r(u.size());
    equations.apply_jacobian(v.data(), r.data());
    equations.precondition(r.data());
    for (std::size_t n = 0; n < u.size(); ++n) EXPECT_NEAR(r[n], v[n], 1e-10) << d;
  }
}

TEST_P(Equations, QualityIsThatOfTheLoop) {
  const loop::Loop loop = sample();
  const std::vector<double> u = point_of(loop);
  const loss::Linearization linearization(pendulum(), loop, loss::Linearization::Order::residual);
  const Collocation::Quality quality = equations.quality(u.data());
  EXPECT_NEAR(quality.loss_rms, std::sqrt(linearization.loss()), 1e-8 * quality.loss_rms);
  EXPECT_NEAR(quality.amplitude, loop::rms_amplitude(loop), 1e-8 * quality.amplitude);
  EXPECT_NEAR(quality.size, loop::rms_size(loop), 1e-8 * quality.size);
}

TEST_P(Equations, LoopsComeBack) {
  const loop::Loop loop = sample();
  EXPECT_LT(loop::mean_distance(equations.to_loop(point_of(loop).data()), loop), 1e-13);
}

TEST_P(Equations, DistanceIsTheArclength) {
  const loop::Loop loop = sample();
  loop::Loop other = loop;
  other.period *= 1.01;
  for (double& v : other.modes) v *= 1.02;
  EXPECT_NEAR(equations.distance(point_of(other).data(), point_of(loop).data()),
              std::hypot(loop::mean_distance(loop, other), 0.01), 1e-9);
}

TEST_P(Equations, ResamplingKeepsTheCurve) {
  const loop::Loop loop = sample();
  const loop::TimeMap sharper{1.3 * GetParam().kappa, {}};
  const Collocation finer(pendulum(), equations.grid().domain(), equations.centre(), equations.winding(), 96, sharper);
  const loop::Loop moved = finer.to_loop(finer.resampled(equations, point_of(loop)).data());
  EXPECT_EQ(moved.time_map.kappa, sharper.kappa);
  for (const double time : {0.0, 0.7, 2.9, 6.1})
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(loop::state_at(moved, time)[i], loop::state_at(loop, time)[i], 1e-10) << time;
}

INSTANTIATE_TEST_SUITE_P(Collocation, Equations,
                         testing::Values(Case{"whole", false, false, 1.0}, Case{"shift", true, false, 1.0},
                                         Case{"mirror", false, true, 1.4}, Case{"both", true, true, 1.0},
                                         Case{"bothMapped", true, true, 1.4}, Case{"wholeMapped", false, false, 1.4}),
                         [](const auto& tested) { return tested.param.name; });

/// x^2 + eps x = c, solved with the slope at another point.
class Square final : public PreconditionedEquations {
 public:
  [[nodiscard]] int size() const override { return 3; }
  void residual(const double* u, double* r) const override {
    for (int n = 0; n < 3; ++n) r[n] = u[n] * u[n] - (n + 1.0) * scale;
  }
  void factor(const double* u) override {
    ++factors;
    for (int n = 0; n < 3; ++n) _slope[n] = 2.0 * u[n];
  }
  void precondition(double* r) const override {
    for (int n = 0; n < 3; ++n) r[n] /= _slope[n];
  }
  double scale = 1.0;
  int factors = 0;

 private:
  double _slope[3] = {};
};

TEST(OrbitSolver, ConvergesWithAKeptFactorAndRenewsAPoorOne) {
  Square equations;
  OrbitSolver solver;
  std::vector<double> u{1.1, 1.3, 1.6};
  EXPECT_TRUE(solver.solve(equations, u, false, {}).converged);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(u[n], std::sqrt(n + 1.0), 1e-12);
  EXPECT_EQ(equations.factors, 1);
  equations.scale = 1.05;
  const AndersonSolver::Result kept = solver.solve(equations, u, true, {});
  EXPECT_TRUE(kept.converged);
  EXPECT_FALSE(kept.factored);
  EXPECT_EQ(equations.factors, 1);
  equations.scale = 400.0;
  u = {19.0, 29.0, 34.0};
  const AndersonSolver::Result renewed = solver.solve(equations, u, true, {});
  EXPECT_TRUE(renewed.converged);
  EXPECT_TRUE(renewed.factored);
  EXPECT_EQ(renewed.factor_point.size(), 3u);
  EXPECT_NEAR(u[2], std::sqrt(1200.0), 1e-10);
}

/// Their residuals are wrong by something that no point makes smaller.
class Rough final : public PreconditionedEquations {
 public:
  [[nodiscard]] int size() const override { return 1; }
  void residual(const double* u, double* r) const override { r[0] = u[0] - 1.0 + 1e-9 * std::cos(1e12 * u[0]); }
  void factor(const double*) override {}
  void precondition(double*) const override {}
};

TEST(OrbitSolver, SaysThatItsChangesShrinkNoMore) {
  OrbitSolver solver;
  std::vector<double> u{1.3};
  AndersonSolver::Options options;
  options.tolerance = 1e-11;
  options.rounding = 1e-13;
  Rough rough;
  const AndersonSolver::Result at_rest = solver.solve(rough, u, false, options);
  EXPECT_TRUE(at_rest.converged);
  EXPECT_TRUE(at_rest.stagnated);
  Square smooth;
  u = {1.1, 1.3, 1.6};
  EXPECT_FALSE(solver.solve(smooth, u, false, {}).stagnated);
}

/// A value in the options database while it lives.
class Option {
 public:
  Option(const char* name, const char* value) : _name(name) { PetscOptionsSetValue(nullptr, name, value); }
  ~Option() { PetscOptionsClearValue(nullptr, _name); }
  Option(const Option&) = delete;
  Option& operator=(const Option&) = delete;

 private:
  const char* _name;
};

AndersonSolver::Result solved_from_afar() {
  Square equations;
  OrbitSolver solver;
  std::vector<double> u{1.5, 1.8, 2.4};
  return solver.solve(equations, u, false, {});
}

TEST(OrbitSolver, TheOptionsDatabaseGoesFirst) {
  const AndersonSolver::Result usual = solved_from_afar();
  ASSERT_TRUE(usual.converged);
  ASSERT_GT(usual.iterations, 4);
  {
    const Option most("-collocation_tao_max_it", "2");
    const AndersonSolver::Result stopped = solved_from_afar();
    EXPECT_FALSE(stopped.converged);
    EXPECT_EQ(stopped.iterations, 2);
  }
  {
    const Option tolerance("-collocation_tao_gatol", "1e-2");
    const AndersonSolver::Result loose = solved_from_afar();
    EXPECT_TRUE(loose.converged);
    EXPECT_LT(loose.iterations, usual.iterations);
  }
  {
    const Option divergence("-collocation_divergence", "1e-3");
    EXPECT_FALSE(solved_from_afar().converged);
  }
  {
    const Option fresh("-collocation_fresh_iterations", "1");
    EXPECT_FALSE(solved_from_afar().converged);
  }
  EXPECT_EQ(solved_from_afar().iterations, usual.iterations);
}

TEST(AndersonSolver, ShowsItsIterations) {
  Square equations;
  AndersonSolver solver;
  std::vector<double> u{1.5, 1.8, 2.4};
  std::vector<double> sizes;
  const AndersonSolver::Result result = solver.solve(equations, u, false, {}, [&](int iteration, double size) {
    EXPECT_EQ(iteration, static_cast<int>(sizes.size()));
    sizes.push_back(size);
  });
  ASSERT_EQ(static_cast<int>(sizes.size()), result.iterations);
  EXPECT_EQ(sizes.front(), result.first_change);
  EXPECT_EQ(sizes.back(), result.last_change);
}

TEST(OrbitSolver, SaysWhereItFails) {
  Square equations;
  equations.scale = -1.0;
  OrbitSolver solver;
  std::vector<double> u{1.0, 1.0, 1.0};
  const AndersonSolver::Result result = solver.solve(equations, u, false, {});
  EXPECT_FALSE(result.converged);
  equations.scale = std::nan("");
  u = {1.0, 1.0, 1.0};
  const AndersonSolver::Result undefined = solver.solve(equations, u, false, {});
  EXPECT_FALSE(undefined.converged);
  EXPECT_FALSE(undefined.finite);
}

}  // namespace
}  // namespace orbweaver::equations::collocation_test
