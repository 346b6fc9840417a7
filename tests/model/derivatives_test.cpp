#include "orbweaver/model/derivatives.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/numerics/quad.hpp"

namespace orbweaver::model::derivatives_test {
namespace {

using numerics::Quad;

constexpr int inputs = 3;

/// Some expression of three inputs and two parameters, of operations drawn by chance, finite near the state below.
int random_expression(Graph& graph, std::mt19937& random) {
  std::vector<int> pool;
  for (int i = 0; i < inputs; ++i) pool.push_back(graph.input(i));
  pool.push_back(graph.parameter(0));
  pool.push_back(graph.parameter(1));
  pool.push_back(graph.decimal(3.0, -1));
  const auto any = [&] { return pool[random() % pool.size()]; };
  const auto small = [&] { return graph.multiply(graph.constant(0.5), graph.sin(any())); };
  for (int n = 0; n < 14; ++n) {
    switch (random() % 14) {
      case 0: pool.push_back(graph.add(any(), any())); break;
      case 1: pool.push_back(graph.subtract(any(), any())); break;
      case 2: pool.push_back(graph.multiply(any(), small())); break;
      case 3: pool.push_back(graph.divide(any(), graph.add(graph.constant(2.0), small()))); break;
      case 4: pool.push_back(graph.sqrt(graph.add(graph.constant(1.0), graph.exp(small())))); break;
      case 5: pool.push_back(graph.exp(small())); break;
      case 6: pool.push_back(graph.log(graph.add(graph.constant(2.0), small()))); break;
      case 7: pool.push_back(graph.cos(any())); break;
      case 8: pool.push_back(graph.tanh(any())); break;
      case 9: pool.push_back(graph.asin(small())); break;
      case 10: pool.push_back(graph.acos(small())); break;
      case 11: pool.push_back(graph.atan(any())); break;
      case 12: pool.push_back(graph.erf(any())); break;
      default: pool.push_back(graph.power(graph.add(graph.constant(2.0), small()), any())); break;
    }
  }
  int sum = pool.back();
  for (int n = 0; n < 4; ++n) sum = graph.add(sum, any());
  return sum;
}

Quad value(const Graph& graph, int node, const std::vector<Quad>& state, const std::vector<Quad>& parameters) {
  return evaluate<Quad>(graph, std::vector<int>{node}, std::span<const Quad>(state), std::span<const Quad>(parameters))
      .front();
}

/// (f(x + h) - f(x - h)) / 2h, wrong by h^2.
Quad difference(const std::function<Quad(const Quad&)>& function, double at) {
  const Quad h = 1e-9;
  return (function(Quad(at) + h) - function(Quad(at) - h)) / (2 * h);
}

void expect_same(const Quad& found, const Quad& expected, const char* what, int number) {
  const Quad size = abs(expected) + 1;
  EXPECT_LT(static_cast<double>(abs(found - expected) / size), 1e-14) << what << " of expression " << number;
}

TEST(Derivatives, AreThoseOfDifferences) {
  std::mt19937 random(5);
  for (int number = 0; number < 1000; ++number) {
    Graph graph;
    const int f = random_expression(graph, random);
    const std::vector<double> state{0.3, -0.8, 1.1};
    const std::vector<double> parameters{0.6, -0.4};
    const std::vector<Quad> z(state.begin(), state.end());
    const std::vector<Quad> p(parameters.begin(), parameters.end());
    const std::vector<int> slopes = jacobian(graph, std::vector<int>{f}, inputs);
    const std::vector<int> backwards = gradient(graph, f, std::vector<int>{0, 1, 2});
    for (std::size_t i = 0; i < inputs; ++i) {
      const Quad expected = difference(
          [&](const Quad& x) {
            std::vector<Quad> moved = z;
            moved[i] = x;
            return value(graph, f, moved, p);
          },
          state[i]);
      expect_same(value(graph, slopes[i], z, p), expected, "slope", number);
      expect_same(backwards[i] < 0 ? Quad(0) : value(graph, backwards[i], z, p), expected, "gradient", number);
      const std::vector<int> second = jacobian(graph, std::vector<int>{slopes[i]}, inputs);
      const std::size_t l = (i + 1) % inputs;
      const Quad bend = difference(
          [&](const Quad& x) {
            std::vector<Quad> moved = z;
            moved[l] = x;
            return value(graph, slopes[i], moved, p);
          },
          state[l]);
      expect_same(value(graph, second[l], z, p), bend, "second derivative", number);
    }
    const int by_parameter =
        derivatives_along(graph, std::vector<int>{f}, {.inputs = {}, .parameters = {-1, graph.constant(1.0)}}).front();
    const Quad expected = difference([&](const Quad& x) { return value(graph, f, z, {p[0], x}); }, parameters[1]);
    expect_same(by_parameter < 0 ? Quad(0) : value(graph, by_parameter, z, p), expected, "by a parameter", number);
  }
}

TEST(Derivatives, AreNoNodesWhereNothingMoves) {
  Graph graph;
  const int x = graph.input(0);
  const int y = graph.input(1);
  const std::vector<int> outputs{graph.multiply(x, x), graph.sin(y)};
  const std::vector<int> entries = jacobian(graph, outputs, 2);
  EXPECT_TRUE(graph.is_constant(entries[1], 0.0));
  EXPECT_TRUE(graph.is_constant(entries[2], 0.0));
  EXPECT_EQ(gradient(graph, outputs[0], std::vector<int>{1}).front(), -1);
}

TEST(Derivatives, PutOtherNodesInThePlaceOfInputs) {
  Graph graph;
  const int x = graph.input(0);
  const int f = graph.multiply(graph.sin(x), graph.tanh(x));
  const int doubled = graph.multiply(graph.constant(2.0), x);
  EXPECT_EQ(substituted(graph, std::vector<int>{f}, {.inputs = {doubled}, .parameters = {}}).front(),
            graph.multiply(graph.sin(doubled), graph.tanh(doubled)));
}

}  // namespace
}  // namespace orbweaver::model::derivatives_test
