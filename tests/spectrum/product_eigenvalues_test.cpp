#include "product_eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/numerics/decompositions.hpp"

namespace product_eigenvalues_test {
namespace {

using namespace orbweaver;

/// Turns by two angles in planes that lie anywhere, off as much as a chain of factors leaves them.
Eigen::MatrixXd two_turns(double first, double second, std::mt19937& random) {
  std::normal_distribution<double> any;
  Eigen::MatrixXd frame(4, 4);
  Eigen::MatrixXd noise(4, 4);
  for (Eigen::Index i = 0; i < frame.size(); ++i) {
    frame(i) = any(random);
    noise(i) = 1e-13 * any(random);
  }
  frame = Eigen::HouseholderQR<Eigen::MatrixXd>(frame).householderQ() * Eigen::MatrixXd::Identity(4, 4);
  Eigen::MatrixXd turns = Eigen::MatrixXd::Zero(4, 4);
  turns.topLeftCorner<2, 2>() << std::cos(first), -std::sin(first), std::sin(first), std::cos(first);
  turns.bottomRightCorner<2, 2>() << std::cos(second), -std::sin(second), std::sin(second), std::cos(second);
  return frame * turns * frame.transpose() + noise;
}

// Both indices are double eigenvalues of B + B^-1, which rounding splits: the real QR iteration goes in circles at a
// few of these.
TEST(ProductEigenvalues, OfTwoPairsOnTheCircleAreFoundWhateverTheirFrame) {
  std::mt19937 random(7);
  for (int n = 0; n < 20000; ++n) {
    const double first = 2.2 + 1e-5 * n;
    const double second = 2.9 - 2e-5 * n;
    std::vector<double> expected{2.0 * std::cos(first), 2.0 * std::cos(second)};
    std::sort(expected.begin(), expected.end());
    std::vector<std::complex<double>> found = spectrum::product_eigenvalues({two_turns(first, second, random)}, true);
    ASSERT_EQ(found.size(), 2U);
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.real() < b.real(); });
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_NEAR(found[i].real(), expected[i], 1e-10) << n;
      ASSERT_LT(std::abs(found[i].imag()), 1e-10) << n;
    }
  }
}

}  // namespace
}  // namespace product_eigenvalues_test
