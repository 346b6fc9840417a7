#include "orbweaver/systems/formulas.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "orbweaver/systems/system.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::formulas_test {
namespace {

/// A state and a matrix V as the graph's inputs.
std::vector<double> inputs_of(const std::vector<double>& z, const std::vector<double>& v) {
  std::vector<double> inputs = z;
  inputs.insert(inputs.end(), v.begin(), v.end());
  return inputs;
}

void expect_same(const std::vector<double>& found, const std::vector<double>& expected, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-12 * (1.0 + std::abs(expected[i]))) << what << ' ' << i;
}

/// The formulas of `system` against its functions at one state.
void expect_formulas_of(const System& system, const std::vector<double>& z, const std::string& name) {
  const Formulas formulas = dynamic_cast<const FormulaSystem&>(system).formulas();
  const auto d = static_cast<std::size_t>(system.dimension());
  std::vector<double> v(d * d);
  for (std::size_t n = 0; n < v.size(); ++n) v[n] = 0.3 + 0.1 * static_cast<double>(n * n % 7);
  const std::vector<double> inputs = inputs_of(z, v);
  const auto values = [&](const std::vector<int>& nodes) {
    return model::evaluate<double>(formulas.graph, nodes, inputs, formulas.values);
  };
  std::vector<double> f(d);
  std::vector<double> jacobian(d * d);
  system.field_jacobian(1, z.data(), f.data(), jacobian.data());
  expect_same(values(formulas.field), f, name + " field");
  std::vector<double> product(d * d, 0.0);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t c = 0; c < d; ++c)
      for (std::size_t l = 0; l < d; ++l) product[i * d + c] += jacobian[i * d + l] * v[l * d + c];
  expect_same(values(formulas.variations), product, name + " variations");
  for (std::size_t k = 0; k < system.structure().conserved.size(); ++k) {
    expect_same(values({formulas.conserved[k]}), {system.conserved(static_cast<int>(k), z)}, name + " conserved");
    std::vector<double> gradient(d);
    system.conserved_gradient(static_cast<int>(k), z, gradient);
    expect_same(values(formulas.conserved_gradients[k]), gradient, name + " gradient");
  }
}

const std::vector<double> state{0.31, -0.42, 0.57, 0.23, 0.77, -0.18, 0.64, 0.05, -0.71, 0.39, -0.26, 0.48};

/// The first values of `state`, as many as the system has coordinates.
std::vector<double> state_of(const System& system) {
  const auto d = static_cast<std::size_t>(system.dimension());
  std::vector<double> z(d);
  for (std::size_t i = 0; i < d; ++i) z[i] = state.at(i);
  return z;
}

TEST(Formulas, AreThoseOfTheSystem) {
  for (const Built& built : all_built()) {
    const auto system = built.with();
    expect_formulas_of(*system, state_of(*system), built.title());
  }
  const auto other = make_system("double_pendulum", {{"m2", 0.3}, {"l1", 0.7}, {"g", 9.81}});
  expect_formulas_of(*other, state_of(*other), "other values");
}

TEST(Formulas, AreToldInTheScales) {
  const Scales scales{0.7, {1.0, 1.0, 0.3, 4.0}, {2.5}, {}};
  const auto in_scales = scaled(make_system("double_pendulum"), scales);
  expect_formulas_of(*in_scales, state_of(*in_scales), "scaled");
  const auto driven = make_system("double_pendulum", {{"pivot_direction", 90.0}}, {"pivot_drive"});
  expect_formulas_of(*scaled(driven, {0.7, {1.0, 1.0, 0.3, 4.0, 1.0}, {}, {}}), state_of(*driven), "scaled, driven");
}

TEST(Formulas, NameTheParameters) {
  const auto system = make_system("double_pendulum", {{"m2", 0.3}});
  const Formulas formulas = dynamic_cast<const FormulaSystem&>(*system).formulas();
  EXPECT_THAT(formulas.parameters, testing::ElementsAre("m1", "m2", "l1", "l2", "g"));
  EXPECT_THAT(formulas.values, testing::ElementsAre(1.0, 0.3, 1.0, 1.0, 1.0));
  EXPECT_EQ(formulas.dimension, 4);
}

}  // namespace
}  // namespace orbweaver::systems::formulas_test
