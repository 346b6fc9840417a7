#include "orbweaver/ad/tape.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "orbweaver/ad/derivatives.hpp"

namespace orbweaver::ad::tape_test {
namespace {

/// All functions of the scalar at once.
template <class S>
S function(const S& x, const S& y, const S& p) {
  using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::pow, std::sin, std::sinh;
  using std::sqrt, std::tan, std::tanh;
  S sum = sin(x) * cos(y) + tan(x * 0.5) - exp(-y) / (x + 2.0) + log(x + y) * sqrt(x);
  sum += asin(y * 0.3) - acos(x * 0.2) * atan(y);
  sum -= sinh(x) + cosh(y) * tanh(p) + pow(x + 1.0, -1.5);
  sum *= p;
  sum /= 3.0 - (y - p) * 1.0 + 0.0 * x;
  return sum + (x - x) - (-y);
}

double through_tape(double x, double y, double p) {
  Recording recording;
  const Recorded result = function(recording.input(0), recording.input(1), recording.parameter(0));
  const std::vector<int> output{result.node()};
  const std::vector<double> inputs{x, y};
  const std::vector<double> parameters{p};
  return evaluate<double>(recording.tape(), output, inputs, parameters).front();
}

TEST(Tape, DoesWhatTheFunctionDoes) {
  for (const double x : {0.3, 1.1})
    for (const double y : {0.2, 0.9}) EXPECT_NEAR(through_tape(x, y, 0.7), function(x, y, 0.7), 1e-14);
}

TEST(Tape, HoldsDerivatives) {
  Recording recording;
  const auto quotient = [](const auto* z) { return z[0] * z[0] * z[1] / 3.0; };
  const std::vector<Recorded> z{recording.input(0), recording.input(1)};
  const auto result = value_gradient<2>(quotient, z.data());
  const std::vector<int> outputs{result.value.node(), result.gradient[0].node(), result.gradient[1].node()};
  const std::vector<double> at{2.0, 5.0};
  const std::vector<double> values = evaluate<double>(recording.tape(), outputs, at, {});
  EXPECT_DOUBLE_EQ(values[0], 20.0 / 3.0);
  EXPECT_DOUBLE_EQ(values[1], 20.0 / 3.0);
  EXPECT_DOUBLE_EQ(values[2], 4.0 / 3.0);
}

TEST(Tape, WritesEqualOperationsOnceAndTrivialOnesNever) {
  Recording recording;
  const Recorded x = recording.input(0);
  const Recorded y = recording.input(1);
  const Recorded product = x * y;
  const std::size_t size = recording.tape().nodes.size();
  EXPECT_EQ((y * x).node(), product.node());
  EXPECT_EQ((product * 1.0).node(), product.node());
  EXPECT_EQ((1.0 * product).node(), product.node());
  EXPECT_NE((2.0 * product).node(), product.node());
  EXPECT_EQ((0.0 + product).node(), product.node());
  EXPECT_EQ((product - 0.0).node(), product.node());
  EXPECT_EQ((product * 0.0).node(), Recorded(0.0).node());
  EXPECT_LE(recording.tape().nodes.size(), size + 4);  // the constants 0, 1 and 2, and one product
  EXPECT_EQ(cos(x).node(), sin(x).node() + 1);
}

TEST(Tape, IsWrittenWithinOneRecording) {
  EXPECT_THROW(Recorded(1.0), core::MisuseError);
  const Recording recording;
  EXPECT_THROW(Recording{}, core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::ad::tape_test
