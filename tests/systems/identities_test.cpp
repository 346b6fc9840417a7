// What must hold for every registered system and combination of its effects, at random states and parameters. A new one
// is tested here without a new line.
#include <cmath>
#include <complex>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::identities_test {
namespace {

using Complex = std::complex<double>;

constexpr int samples = 25;

class Identities : public testing::TestWithParam<Built> {
 protected:
  std::mt19937 generator{2024};
  const std::size_t dimension = GetParam().with()->info().state_names.size();

  std::shared_ptr<const System> random_system() {
    return GetParam().with(random_parameters(model_info(GetParam().name), generator, GetParam().effects));
  }
  std::vector<double> random_state(const System& system) { return orbweaver::systems::random_state(system, generator); }

  static Eigen::VectorXd field(const System& system, const Eigen::VectorXd& z) {
    Eigen::VectorXd f(z.size());
    system.field(1, z.data(), f.data());
    return f;
  }

  static Eigen::VectorXd vector(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  std::vector<double> jacobian(const System& system, const std::vector<double>& z) const {
    std::vector<double> f(dimension);
    std::vector<double> entries(dimension * dimension);
    system.field_jacobian(1, z.data(), f.data(), entries.data());
    return entries;
  }
};

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

TEST_P(Identities, JacobianAgreesWithComplexStep) {
  constexpr double h = 1e-200;
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto z = random_state(*system);
    const auto entries = jacobian(*system, z);
    for (std::size_t l = 0; l < dimension; ++l) {
      std::vector<Complex> shifted(z.begin(), z.end());
      shifted[l] += Complex(0.0, h);
      const std::vector<Complex> f = evaluated(*system, shifted, &Formulas::field);
      for (std::size_t i = 0; i < dimension; ++i)
        EXPECT_NEAR(entries[i * dimension + l], f[i].imag() / h, 1e-13 * (1.0 + largest(entries)));
    }
  }
}

TEST_P(Identities, QuadruplePrecisionAgreesWithDouble) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto& quad_system = dynamic_cast<const QuadSystem&>(*system);
    const Eigen::VectorXd z = vector(random_state(*system));
    const std::vector<double> entries = jacobian(*system, {z.begin(), z.end()});
    numerics::QuadVector f;
    numerics::QuadMatrix derivatives;
    quad_system.linearize(z.cast<numerics::Quad>(), f, derivatives);
    EXPECT_LT((f.cast<double>() - field(*system, z)).norm(), 1e-13 * (1.0 + f.cast<double>().norm()));
    for (std::size_t i = 0; i < dimension; ++i)
      for (std::size_t l = 0; l < dimension; ++l)
        EXPECT_NEAR(entries[i * dimension + l],
                    derivatives(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(l)).convert_to<double>(),
                    1e-13 * (1.0 + largest(entries)));
    // A difference over 1e-12 is right to 1e-20 only if the field is evaluated in quadruple precision.
    const numerics::Quad h = 1e-12;
    for (Eigen::Index l = 0; l < z.size(); ++l) {
      numerics::QuadVector beside = z.cast<numerics::Quad>();
      numerics::QuadVector above;
      numerics::QuadVector below;
      numerics::QuadMatrix unused;
      beside(l) += h;
      quad_system.linearize(beside, above, unused);
      beside(l) -= 2 * h;
      quad_system.linearize(beside, below, unused);
      const numerics::QuadVector error = (above - below) / (2 * h) - derivatives.col(l);
      EXPECT_LT(error.norm().convert_to<double>(), 1e-17 * (1.0 + largest(entries)));
    }
    EXPECT_THROW(quad_system.linearize(numerics::QuadVector::Zero(1), f, derivatives), core::MisuseError);
  }
}

TEST_P(Identities, ParameterDerivativesAreDerivativesOfTheField) {
  // Central differences of order eight.
  constexpr double h = 0.003;
  constexpr std::array<double, 4> stencil{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto z = random_state(*system);
    for (const auto& [name, value] : system->parameters()) {
      if (is_count(name)) continue;
      std::vector<double> derivatives(dimension);
      system->parameter_derivatives(name, 1, z.data(), derivatives.data());
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(dimension));
      // Next to the smallest values that are drawn rounding would decide.
      const double step = h * std::max(std::abs(value), 0.01);
      for (std::size_t k = 0; k < stencil.size(); ++k) {
        const double away = step * static_cast<double>(k + 1);
        expected += stencil[k] / step *
                    (field(*system->with_parameters({{name, value + away}}), vector(z)) -
                     field(*system->with_parameters({{name, value - away}}), vector(z)));
      }
      for (std::size_t i = 0; i < dimension; ++i)
        EXPECT_NEAR(derivatives[i], expected(static_cast<Eigen::Index>(i)), 1e-10 * (1.0 + largest(derivatives)))
            << name;
    }
    std::vector<double> out(dimension);
    EXPECT_THROW(system->parameter_derivatives("no such", 1, z.data(), out.data()), core::MisuseError);
    EXPECT_THROW(static_cast<void>(system->with_parameters({{"no such", 1.0}})), core::MisuseError);
  }
}

TEST_P(Identities, SecondDerivativesAreDerivativesOfTheJacobian) {
  // Central differences of order eight.
  constexpr double h = 0.003;
  constexpr std::array<double, 4> stencil{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto z = random_state(*system);
    const auto weights = random_numbers(dimension, generator);
    std::vector<double> contracted(dimension * dimension);
    system->second_derivatives(1, z.data(), weights.data(), contracted.data());
    for (std::size_t m = 0; m < dimension; ++m) {
      std::vector<double> column(dimension, 0.0);
      for (std::size_t k = 0; k < stencil.size(); ++k) {
        auto above = z;
        auto below = z;
        above[m] += h * static_cast<double>(k + 1);
        below[m] -= h * static_cast<double>(k + 1);
        const auto upper = jacobian(*system, above);
        const auto lower = jacobian(*system, below);
        for (std::size_t i = 0; i < dimension; ++i)
          for (std::size_t l = 0; l < dimension; ++l)
            column[l] += weights[i] * stencil[k] * (upper[i * dimension + l] - lower[i * dimension + l]) / h;
      }
      for (std::size_t l = 0; l < dimension; ++l) {
        EXPECT_NEAR(contracted[l * dimension + m], column[l], 1e-10 * (1.0 + largest(contracted)));
        EXPECT_EQ(contracted[l * dimension + m], contracted[m * dimension + l]);
      }
    }
  }
}

TEST_P(Identities, GradientsOfConservedQuantitiesAgreeWithComplexStep) {
  constexpr double h = 1e-200;
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto z = random_state(*system);
    for (int k = 0; k < static_cast<int>(system->structure().conserved.size()); ++k) {
      std::vector<double> gradient(dimension);
      system->conserved_gradient(k, z, gradient);
      for (std::size_t l = 0; l < dimension; ++l) {
        std::vector<Complex> shifted(z.begin(), z.end());
        shifted[l] += Complex(0.0, h);
        const Complex value = evaluated(*system, shifted, &Formulas::conserved)[static_cast<std::size_t>(k)];
        EXPECT_NEAR(gradient[l], value.imag() / h, 1e-13 * (1.0 + largest(gradient)));
        EXPECT_NEAR(system->conserved(k, z), value.real(), 1e-13 * (1.0 + std::abs(value.real())));
      }
    }
  }
}

// What a survey asks before its first task, to rounding.
TEST_P(Identities, TheStructureHoldsForTheField) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    std::vector<std::vector<double>> states;
    for (int n = 0; n < samples; ++n) states.push_back(random_state(*system));
    const std::vector<IdentityError> errors = identity_errors(*system, states);
    EXPECT_FALSE(errors.empty() && (system->structure().conservative() || system->structure().driven));
    for (const IdentityError& found : errors) {
      // z + 2 pi itself is rounded, and so is a phase and half a turn.
      const bool turned = found.identity.find("2 pi") != std::string::npos || system->structure().driven;
      EXPECT_LE(found.error, turned ? 1e-13 : 1e-14) << found.identity;
    }
  }
}

/// Of systems with an energy; the equations of the others stand in effects_test.cpp and oscillators_test.cpp.
class ConservativeIdentities : public Identities {};

// Coordinates q, v = dq/dt with the Lagrangian L = p . v - H: the field must obey its Euler-Lagrange equations, which
// hold the momenta of the action against the energy and both against the field, gyroscopic terms included. L_vv v' =
// L_q - L_vq v by central differences of order eight, in and across the coordinates. Of coordinates q, p:
// dq/dt = dH/dp and dp/dt = -dH/dq, and the action is that of p.
TEST_P(ConservativeIdentities, TheActionIsStationaryAlongOrbits) {
  constexpr double h = 0.02;
  constexpr std::array<double, 4> stencil{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  for (int sample = 0; sample < samples; ++sample) {
    const auto system = random_system();
    const auto state = random_state(*system);
    const Eigen::VectorXd z = vector(state);
    const Eigen::VectorXd f = field(*system, z);
    const auto n = z.size() / 2;
    if (f.head(n) != z.tail(n)) {  // the velocities are no coordinates: canonical momenta must be
      Eigen::VectorXd by_state(2 * n);
      system->conserved_gradient(0, state, {by_state.data(), state.size()});
      const double size = 1.0 + f.norm();
      EXPECT_LT((f.head(n) - by_state.tail(n)).norm(), 1e-14 * size);
      EXPECT_LT((f.tail(n) + by_state.head(n)).norm(), 1e-14 * size);
      EXPECT_NEAR(system->action_density(state), z.tail(n).dot(f.head(n)), 1e-14 * size * (1.0 + z.norm()));
      continue;
    }
    const auto lagrangian = [&](const Eigen::VectorXd& at) {
      const std::span<const double> numbers(at.data(), dimension);
      return system->action_density(numbers) - system->conserved(0, numbers);
    };
    const auto along = [&](const auto& function, const Eigen::VectorXd& at, const Eigen::VectorXd& way) {
      double sum = 0.0;
      for (std::size_t k = 0; k < stencil.size(); ++k) {
        const Eigen::VectorXd away = h * static_cast<double>(k + 1) * way;
        sum += stencil[k] / h * (function(at + away) - function(at - away));
      }
      return sum;
    };
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(2 * n, 2 * n);
    const double length = f.norm();
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto momentum = [&](const Eigen::VectorXd& at) { return along(lagrangian, at, unit.col(n + i)); };
      const double force = along(lagrangian, z, unit.col(i));
      EXPECT_NEAR(length * along(momentum, z, f / length), force, 1e-8 * (1.0 + std::abs(force) + length));
    }
  }
}

TEST_P(Identities, NodalArraysAreComponentMajor) {
  constexpr std::size_t nodes = 5;
  const auto system = random_system();
  const auto z = random_numbers(dimension * nodes, generator);
  const auto weights = random_numbers(dimension * nodes, generator);
  std::vector<double> f(dimension * nodes);
  std::vector<double> g(dimension * nodes);
  std::vector<double> entries(dimension * dimension * nodes);
  std::vector<double> contracted(dimension * dimension * nodes);
  system->field(nodes, z.data(), f.data());
  system->field_jacobian(nodes, z.data(), g.data(), entries.data());
  system->second_derivatives(nodes, z.data(), weights.data(), contracted.data());
  for (std::size_t j = 0; j < nodes; ++j) {
    std::vector<double> state(dimension);
    std::vector<double> weight(dimension);
    for (std::size_t i = 0; i < dimension; ++i) {
      state[i] = z[i * nodes + j];
      weight[i] = weights[i * nodes + j];
    }
    const Eigen::VectorXd one = field(*system, vector(state));
    const auto one_jacobian = jacobian(*system, state);
    std::vector<double> one_contracted(dimension * dimension);
    system->second_derivatives(1, state.data(), weight.data(), one_contracted.data());
    for (std::size_t i = 0; i < dimension; ++i) {
      EXPECT_EQ(f[i * nodes + j], one[static_cast<Eigen::Index>(i)]);
      EXPECT_NEAR(g[i * nodes + j], f[i * nodes + j], 1e-14 * (1.0 + one.norm()));
    }
    for (std::size_t entry = 0; entry < dimension * dimension; ++entry) {
      EXPECT_EQ(entries[entry * nodes + j], one_jacobian[entry]);
      EXPECT_EQ(contracted[entry * nodes + j], one_contracted[entry]);
    }
  }
}

// Every nodal function at every number of nodes and at every place, against the same state alone.
TEST_P(Identities, NodesDoNotSeeEachOther) {
  constexpr std::size_t most = 19;
  const auto system = random_system();
  const std::size_t d = dimension;
  const bool conserves = system->structure().conservative();
  const auto evaluate = [&](std::size_t nodes, const std::vector<double>& z, const std::vector<double>& weights) {
    std::vector<double> out((3 * d + 2 * d * d) * nodes);
    system->field(nodes, z.data(), out.data());
    if (conserves) system->conserved_gradients(0, nodes, z.data(), &out[d * nodes]);
    system->field_jacobian(nodes, z.data(), &out[2 * d * nodes], &out[3 * d * nodes]);
    system->second_derivatives(nodes, z.data(), weights.data(), &out[(3 * d + d * d) * nodes]);
    return out;
  };
  const auto state = random_state(*system);
  const auto weight = random_numbers(d, generator);
  const auto alone = evaluate(1, state, weight);
  std::vector<double> gradient(d);
  if (conserves) system->conserved_gradient(0, state, gradient);
  for (std::size_t i = 0; i < d; ++i) EXPECT_EQ(alone[d + i], gradient[i]);
  for (std::size_t nodes = 1; nodes <= most; ++nodes) {
    for (std::size_t place = 0; place < nodes; ++place) {
      // The others: far out, where sines go another way, or not a number.
      auto z = random_numbers(d * nodes, generator);
      auto weights = random_numbers(d * nodes, generator);
      for (std::size_t j = 0; j < nodes; ++j)
        for (std::size_t i = 0; i < d; ++i) {
          if (j % 3 == 1) z[i * nodes + j] *= 1e7;
          if (j % 3 == 2) z[i * nodes + j] = std::numeric_limits<double>::quiet_NaN();
        }
      for (std::size_t i = 0; i < d; ++i) {
        z[i * nodes + place] = state[i];
        weights[i * nodes + place] = weight[i];
      }
      const auto together = evaluate(nodes, z, weights);
      for (std::size_t row = 0; row < alone.size(); ++row)
        ASSERT_EQ(together[row * nodes + place], alone[row]) << "row " << row << " at " << place << " of " << nodes;
    }
  }
}

TEST_P(Identities, FieldAgreesWithComplexFieldFarOut) {
  for (const double scale : {1.0, 1e2, 1e5}) {
    const auto system = random_system();
    auto z = random_state(*system);
    for (double& coordinate : z) coordinate *= scale;
    const std::vector<Complex> at(z.begin(), z.end());
    const std::vector<Complex> expected = evaluated(*system, at, &Formulas::field);
    const Eigen::VectorXd f = field(*system, vector(z));
    for (std::size_t i = 0; i < dimension; ++i)
      EXPECT_NEAR(f[static_cast<Eigen::Index>(i)], expected[i].real(), 1e-14 * (1.0 + f.norm()));
  }
}

std::vector<Built> conservative_ones() {
  std::vector<Built> all = all_built();
  std::erase_if(all, [](const Built& built) { return !built.with()->structure().conservative(); });
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllSystems, ConservativeIdentities, testing::ValuesIn(conservative_ones()),
                         [](const testing::TestParamInfo<Built>& test) { return test.param.title(); });
INSTANTIATE_TEST_SUITE_P(AllSystems, Identities, testing::ValuesIn(all_built()),
                         [](const testing::TestParamInfo<Built>& test) { return test.param.title(); });

}  // namespace
}  // namespace orbweaver::systems::identities_test
