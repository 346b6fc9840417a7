#include "orbweaver/loss/linearization.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "loss/cases.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::loss::linearization_test {
namespace {

using test::Case;
using test::make_case;
using test::two_pi;
using Order = Linearization::Order;

// dz/dt - f at phase s, from the definition.
std::vector<double> residual_at(const systems::System& system, const loop::Loop& loop, double s) {
  const test::Direct z = test::direct_sum(loop, s);
  std::vector<double> f(z.state.size());
  system.field(1, z.state.data(), f.data());
  const double density = loop.time_map.density(s);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = two_pi / loop.period * z.slope[i] / density - f[i];
  return f;
}

double mean_square_residual(const systems::System& system, const loop::Loop& loop, int points) {
  double sum = 0.0;
  for (int j = 0; j < points; ++j) sum += test::squared(residual_at(system, loop, two_pi * j / points));
  return sum / points;
}

TEST(Linearization, ResidualIsItsDefinitionAtTheNodes) {
  for (const std::string& name : test::case_names()) {
    const Case sample = make_case(name);
    const Linearization here = test::linearize(sample, Order::residual);
    const std::vector<double> residual = here.residual();
    const auto n = static_cast<std::size_t>(here.nodes());
    ASSERT_EQ(residual.size(), static_cast<std::size_t>(here.rows()));
    for (std::size_t j = 0; j < n; ++j) {
      const double s = two_pi * static_cast<double>(j) / here.nodes();
      const std::vector<double> expected = residual_at(*sample.system, sample.loop, s);
      const double weight = sample.loop.time_map.density(s) / static_cast<double>(n);
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(residual[i * n + j] / std::sqrt(weight), expected[i], 1e-12) << name;
    }
  }
}

// The field of Henon and Heiles is of degree two, so |r|^2 has 4K harmonics, fewer than N: the mean is the integral.
TEST(Linearization, LossIsTheIntegralAndNotOnlyAMeanOverNodes) {
  const auto system = systems::make_system("henon_heiles");
  for (const int cutoff : {1, 2, 5, 10}) {
    const loop::Loop loop = test::random_loop(4, cutoff, 81);
    const double integral = mean_square_residual(*system, loop, 1000);
    EXPECT_NEAR(Linearization(*system, loop, Order::residual).loss(), integral, 1e-13 * integral) << "K = " << cutoff;
  }
}

TEST(Linearization, LossConvergesToTheIntegralOfAnyField) {
  const auto system = systems::make_system("double_pendulum");
  loop::Loop loop = test::random_loop(4, 3, 82, 4.2, 0.4);
  loop.winding = {1.0, 0.0, 0.0, 0.0};
  const double integral = mean_square_residual(*system, loop, 2000);
  double last = std::abs(Linearization(*system, loop, Order::residual).loss() - integral) / integral;
  for (const int cutoff : {7, 17}) {
    const double error =
        std::abs(Linearization(*system, loop::with_cutoff(loop, cutoff), Order::residual).loss() - integral) / integral;
    EXPECT_LT(error, 0.1 * last + 1e-14) << "K = " << cutoff;
    last = error;
  }
  EXPECT_LT(std::abs(Linearization(*system, loop::with_cutoff(loop, 31), Order::residual).loss() - integral),
            1e-13 * integral);
}

TEST(Linearization, TellsItsSizes) {
  const Case sample = make_case("pendulum_symmetric_period");
  const Linearization here = test::linearize(sample, Order::jacobian);
  EXPECT_EQ(here.nodes(), loop::FourierGrid::nodes_for(9));
  EXPECT_EQ(here.rows(), 4 * here.nodes());
  EXPECT_EQ(here.cutoff(), 9);
  EXPECT_EQ(here.order(), Order::jacobian);
  EXPECT_DOUBLE_EQ(here.rate() * here.period(), two_pi);
}

TEST(LinearizationMisuse, InvalidLoopsAreRefused) {
  const auto system = systems::make_system("double_pendulum");
  const loop::Loop good = test::random_loop(4, 3, 83);
  const auto refused = [&](auto&& spoil) {
    loop::Loop bad = good;
    spoil(bad);
    EXPECT_THROW(Linearization(*system, bad, Order::jacobian), core::MisuseError);
  };
  for (const double period :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    refused([&](loop::Loop& l) { l.period = period; });
  refused([](loop::Loop& l) { l.cutoff = 0; });
  refused([](loop::Loop& l) { l.modes.pop_back(); });
  refused([](loop::Loop& l) { l.modes[3] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_THROW(Linearization(*system, test::random_loop(2, 3, 83), Order::jacobian), core::MisuseError)
      << "another dimension";
}

TEST(LinearizationMisuse, TooLowAnOrderIsRefused) {
  const Case sample = make_case("pendulum_symmetric_period");
  const std::vector<double> v(static_cast<std::size_t>(sample.unknowns.size()), 1.0);
  const Linearization residual = test::linearize(sample, Order::residual);
  const std::vector<double> y(static_cast<std::size_t>(residual.rows()), 1.0);
  EXPECT_THROW(static_cast<void>(residual.apply_jacobian(sample.unknowns, v)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(residual.apply_jacobian_transposed(sample.unknowns, y)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(residual.gradient(sample.unknowns)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(residual.apply_hessian(sample.unknowns, v, Curvature::gauss_newton)),
               core::MisuseError);
  const Linearization jacobian = test::linearize(sample, Order::jacobian);
  EXPECT_NO_THROW(static_cast<void>(jacobian.apply_hessian(sample.unknowns, v, Curvature::gauss_newton)));
  EXPECT_THROW(static_cast<void>(jacobian.apply_hessian(sample.unknowns, v, Curvature::full)), core::MisuseError);
}

TEST(LinearizationMisuse, WrongSizesAreRefused) {
  const Case sample = make_case("pendulum_symmetric_period");
  const Linearization here = test::linearize(sample, Order::second);
  const auto size = static_cast<std::size_t>(sample.unknowns.size());
  const auto rows = static_cast<std::size_t>(here.rows());
  EXPECT_THROW(static_cast<void>(here.apply_jacobian(sample.unknowns, std::vector<double>(size - 1))),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(here.apply_hessian(sample.unknowns, std::vector<double>(size + 1), Curvature::full)),
               core::MisuseError);
  EXPECT_THROW(static_cast<void>(here.apply_jacobian_transposed(sample.unknowns, std::vector<double>(rows - 1))),
               core::MisuseError);
  for (const int cutoff : {4, 20}) {
    const Unknowns other{loop::Subspace::unrestricted(4, cutoff), {Scalar::period()}};
    const std::vector<double> v(static_cast<std::size_t>(other.size()), 0.0);
    EXPECT_THROW(static_cast<void>(here.apply_jacobian(other, v)), core::MisuseError) << "K = " << cutoff;
    EXPECT_THROW(static_cast<void>(here.apply_jacobian_transposed(other, std::vector<double>(rows))), core::MisuseError)
        << "K = " << cutoff;
  }
}

}  // namespace
}  // namespace orbweaver::loss::linearization_test
