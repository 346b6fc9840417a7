#include "orbweaver/model/block_program.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/recorded.hpp"

namespace orbweaver::model::block_program_test {
namespace {

std::vector<double> run(const BlockProgram& program, const std::vector<double>& parameters,
                        const std::vector<std::vector<double>>& inputs, std::size_t outputs) {
  const std::size_t states = inputs.front().size();
  std::vector<const double*> in;
  for (const std::vector<double>& row : inputs) in.push_back(row.data());
  std::vector<double> values(outputs * states);
  std::vector<double*> out;
  for (std::size_t k = 0; k < outputs; ++k) out.push_back(values.data() + k * states);
  program.run(program.scalars(parameters), states, in, out);
  return values;
}

TEST(BlockProgram, DoesWhatTheGraphSays) {
  Recording recording;
  const Recorded x = recording.input(0), y = recording.input(1), p = recording.parameter(0), q = recording.parameter(1);
  const Recorded wave = sin(x) * cos(x) - cos(y * p);
  const Recorded share = 1.0 / (x * x + p * q);
  const std::vector<Recorded> wanted{
      wave,  share * wave - q, p - x,      p / (y * y + 1.0), x, p * q - 3.0, share * wave - q, -exp(x - y),
      y / p, Recorded(0.0),    tanh(y) * q};
  std::vector<int> outputs;
  for (const Recorded& value : wanted) outputs.push_back(value.node());
  const BlockProgram program(recording.graph(), outputs);
  const std::vector<double> parameters{0.7, -1.3};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  for (const std::size_t states : {1, 7, 8, 63, 64, 200}) {
    std::vector<std::vector<double>> inputs(2, std::vector<double>(states));
    for (auto& row : inputs)
      for (double& value : row) value = uniform(random);
    const std::vector<double> values = run(program, parameters, inputs, outputs.size());
    for (std::size_t j = 0; j < states; ++j) {
      const std::vector<double> state{inputs[0][j], inputs[1][j]};
      const auto expected = evaluate<double>(recording.graph(), outputs, state, std::span<const double>(parameters));
      for (std::size_t k = 0; k < outputs.size(); ++k)
        EXPECT_NEAR(values[k * states + j], expected[k], 4e-15 * (1.0 + std::abs(expected[k]))) << k;
    }
  }
}

TEST(BlockProgram, AStatesBitsHangOnNothingElse) {
  Recording recording;
  const Recorded x = recording.input(0);
  const std::vector<int> outputs{(exp(x) * sin(x) / (1.0 + x * x)).node(), log(x * x + 1.0).node()};
  const BlockProgram program(recording.graph(), outputs);
  std::vector<double> many(131);
  for (std::size_t j = 0; j < many.size(); ++j) many[j] = 0.37 * static_cast<double>(j) - 20.0;
  const std::vector<double> together = run(program, {}, {many}, 2);
  for (std::size_t j = 0; j < many.size(); ++j) {
    const std::vector<double> alone = run(program, {}, {{many[j]}}, 2);
    EXPECT_EQ(alone[0], together[j]);
    EXPECT_EQ(alone[1], together[many.size() + j]);
    std::vector<double> one(2);
    program.run_one(program.scalars({}), std::vector<double>{many[j]}, {one});
    EXPECT_EQ(one[0], together[j]);
    EXPECT_EQ(one[1], together[many.size() + j]);
  }
}

/// How many units in the last place a function of the kernels is off from the standard library's in long doubles.
struct Function {
  const char* name;
  int (Graph::*recorded)(int);
  long double (*exact)(long double);
  double lower;
  double upper;
  double units;
};

TEST(BlockProgram, FunctionsAreRightToFewUnitsInTheLastPlace) {
  const std::array functions{
      Function{"exp", &Graph::exp, std::exp, -745.0, 709.7, 1.0},
      Function{"log", &Graph::log, std::log, 1e-300, 10.0, 1.0},
      Function{"log", &Graph::log, std::log, 1e-320, 1e-310, 1.0},
      Function{"sin", &Graph::sin, std::sin, -40.0, 40.0, 1.0},
      Function{"cos", &Graph::cos, std::cos, -3e4, 3e4, 1.0},
      Function{"sin far", &Graph::sin, std::sin, 1e5, 1e9, 1.0},
      Function{"tanh", &Graph::tanh, std::tanh, -3.0, 3.0, 2.5},
      Function{"tanh far", &Graph::tanh, std::tanh, -800.0, 800.0, 2.0},
      Function{"atan", &Graph::atan, std::atan, -5.0, 5.0, 1.5},
      Function{"atan far", &Graph::atan, std::atan, -1e9, 1e9, 1.5},
      Function{"asin", &Graph::asin, std::asin, -1.0, 1.0, 4.0},
      Function{"acos", &Graph::acos, std::acos, -1.0, 1.0, 4.0},
      Function{"sqrt", &Graph::sqrt, std::sqrt, 0.0, 1e9, 0.51},
      Function{"erf", &Graph::erf, std::erf, -6.0, 6.0, 1.0},
      Function{"exp near 0", &Graph::exp, std::exp, -1e-3, 1e-3, 1.0},
      Function{"tanh near 0", &Graph::tanh, std::tanh, -0.01, 0.01, 1.5},
  };
  std::mt19937 random(2);
  for (const Function& function : functions) {
    Graph graph;
    const std::vector<int> output{(graph.*function.recorded)(graph.input(0))};
    const BlockProgram program(graph, output);
    std::uniform_real_distribution<double> uniform(function.lower, function.upper);
    std::vector<double> x(20000);
    for (double& value : x) value = uniform(random);
    const std::vector<double> y = run(program, {}, {x}, 1);
    double worst = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const long double exact = function.exact(x[j]);
      const auto nearest = std::abs(static_cast<double>(exact));
      const double unit = std::max(std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest, 5e-324);
      worst = std::max(worst, static_cast<double>(std::abs(y[j] - exact) / unit));
    }
    EXPECT_LT(worst, function.units) << function.name;
  }
}

TEST(BlockProgram, FunctionsHaveTheirLimits) {
  Recording recording;
  const Recorded x = recording.input(0);
  const std::vector<int> outputs{exp(x).node(), log(x).node(), atan(x).node(), tanh(x).node(), sin(x).node()};
  const BlockProgram program(recording.graph(), outputs);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> y = run(program, {}, {{infinity, -infinity, 0.0, std::nan(""), -1.0}}, 5);
  const auto at = [&](std::size_t k, std::size_t j) { return y[k * 5 + j]; };
  EXPECT_EQ(at(0, 0), infinity);
  EXPECT_EQ(at(0, 1), 0.0);
  EXPECT_EQ(at(0, 2), 1.0);
  EXPECT_EQ(at(1, 0), infinity);
  EXPECT_EQ(at(1, 2), -infinity);
  EXPECT_TRUE(std::isnan(at(1, 1)));
  EXPECT_TRUE(std::isnan(at(1, 4)));
  EXPECT_DOUBLE_EQ(at(2, 0), std::atan(infinity));
  EXPECT_EQ(at(3, 0), 1.0);
  EXPECT_EQ(at(3, 1), -1.0);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_TRUE(std::isnan(at(k, 3))) << k;
  EXPECT_TRUE(std::isnan(at(4, 0)));
}

}  // namespace
}  // namespace orbweaver::model::block_program_test
