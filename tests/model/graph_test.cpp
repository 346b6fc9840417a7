#include "orbweaver/model/recorded.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/model/evaluate.hpp"

namespace orbweaver::model::graph_test {
namespace {

/// All functions of the scalar at once.
template <class S>
S function(const S& x, const S& y, const S& p) {
  using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::pow, std::sin, std::sinh;
  using std::erf, std::sqrt, std::tan, std::tanh;
  S sum = sin(x) * cos(y) + tan(x * 0.5) - exp(-y) / (x + 2.0) + log(x + y) * sqrt(x);
  sum += asin(y * 0.3) - acos(x * 0.2) * atan(y);
  sum -= sinh(x) + cosh(y) * tanh(p) + pow(x + 1.0, S(-1.5)) * pow(y, S(0.3)) - erf(x - y);
  sum *= p;
  sum /= 3.0 - (y - p) * 1.0 + 0.0 * x;
  return sum + (x - x) - (-y);
}

double through_graph(double x, double y, double p) {
  Recording recording;
  const Recorded result = function(recording.input(0), recording.input(1), recording.parameter(0));
  const std::vector<int> output{result.node()};
  const std::vector<double> inputs{x, y};
  const std::vector<double> parameters{p};
  return evaluate<double>(recording.graph(), output, inputs, parameters).front();
}

TEST(Graph, DoesWhatTheFunctionDoes) {
  for (const double x : {0.3, 1.1})
    for (const double y : {0.2, 0.9}) EXPECT_NEAR(through_graph(x, y, 0.7), function(x, y, 0.7), 1e-14);
}

TEST(Graph, DoesAtOnceWhatADoubleHolds) {
  Graph graph;
  const auto value = [&](int n) { return graph.is_constant(n) ? graph.node(n).value : std::nan(""); };
  EXPECT_EQ(value(graph.add(graph.constant(1.0), graph.constant(2.0))), 3.0);
  EXPECT_EQ(value(graph.divide(graph.constant(1.0), graph.constant(8.0))), 0.125);
  EXPECT_EQ(value(graph.power(graph.constant(9.0), graph.divide(graph.constant(3.0), graph.constant(2.0)))), 27.0);
  EXPECT_TRUE(std::isnan(value(graph.divide(graph.constant(1.0), graph.constant(3.0)))));
  EXPECT_TRUE(std::isnan(value(graph.decimal(1.0, -1))));
  EXPECT_TRUE(std::isnan(value(graph.add(graph.constant(1.0), graph.constant(1e-17)))));
  const std::vector<int> numbers{graph.decimal(1.0, -1), graph.decimal(1215058560962404.0, -17), graph.pi(),
                                 graph.decimal(662607015.0, -42)};
  const std::vector<double> values = evaluate<double>(graph, numbers, std::vector<double>{}, std::vector<double>{});
  EXPECT_EQ(values[0], 0.1);
  EXPECT_EQ(values[1], 0.01215058560962404);
  EXPECT_EQ(values[2], 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(values[3], 6.62607015e-34);
}

TEST(Graph, WritesEqualOperationsOnceAndTrivialOnesNever) {
  Recording recording;
  const Recorded x = recording.input(0);
  const Recorded y = recording.input(1);
  const Recorded product = x * y;
  const std::size_t size = recording.graph().nodes().size();
  EXPECT_EQ((y * x).node(), product.node());
  EXPECT_EQ((product * 1.0).node(), product.node());
  EXPECT_EQ((1.0 * product).node(), product.node());
  EXPECT_NE((2.0 * product).node(), product.node());
  EXPECT_EQ((0.0 + product).node(), product.node());
  EXPECT_EQ((product - 0.0).node(), product.node());
  EXPECT_EQ((product * 0.0).node(), Recorded(0.0).node());
  EXPECT_LE(recording.graph().nodes().size(), size + 4);  // the constants 0, 1 and 2, and one product
  EXPECT_EQ(cos(x).node(), sin(x).node() + 1);
}

TEST(Graph, IsWrittenWithinOneRecording) {
  EXPECT_THROW(Recorded(1.0), core::MisuseError);
  const Recording recording;
  EXPECT_THROW(Recording{}, core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::model::graph_test
