#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/numerics/lagrange.hpp"

namespace lagrange_test {
namespace {

using namespace orbweaver;
using numerics::lagrange_weights;

double sum(const std::vector<double>& weights, const std::vector<double>& nodes, double power) {
  double out = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) out += weights[n] * std::pow(nodes[n], power);
  return out;
}

TEST(LagrangeWeights, AreExactForPolynomials) {
  const std::vector<double> nodes{-0.7, 2.1, 0.4, 1.3};
  for (const double x : {-1.0, 0.0, 0.9, 3.0}) {
    const numerics::LagrangeWeights weights = lagrange_weights(nodes, x);
    for (int power = 0; power <= 3; ++power) {
      EXPECT_NEAR(sum(weights.value, nodes, power), std::pow(x, power), 1e-13) << x << "^" << power;
      const double slope = power == 0 ? 0.0 : power * std::pow(x, power - 1);
      EXPECT_NEAR(sum(weights.slope, nodes, power), slope, 1e-13) << x << "^" << power;
    }
    EXPECT_GT(std::abs(sum(weights.value, nodes, 4) - std::pow(x, 4)), 1e-3) << "four nodes hold no quartic";
  }
}

TEST(LagrangeWeights, AreOneAndZeroAtANode) {
  const std::vector<double> nodes{0.1, 0.3, 0.7};
  EXPECT_EQ(lagrange_weights(nodes, 0.3).value, (std::vector<double>{0.0, 1.0, 0.0}));
  EXPECT_EQ(lagrange_weights(std::vector<double>{5.0}, 1.0).value, std::vector<double>{1.0});
  EXPECT_EQ(lagrange_weights(std::vector<double>{5.0}, 1.0).slope, std::vector<double>{0.0});
}

}  // namespace
}  // namespace lagrange_test
