#include "support/dual_derivatives.hpp"

#include <cmath>
#include <complex>
#include <random>

#include <gtest/gtest.h>

namespace derivatives_test {
namespace {

namespace ad = orbweaver::ad;

constexpr int dimension = 3;

/// Every operation that a vector field is likely to use, with constants on both sides and a component without
/// derivatives.
struct MixedField {
  template <class S>
  void operator()(const S* z, S* f) const {
    using std::cos;
    using std::exp;
    using std::sin;
    using std::sqrt;
    const S denominator = S(2.0) + cos(z[0] - z[1]) * 0.5;
    const S root = sqrt(1.5 + z[2] * z[2]);
    f[0] = (sin(z[0]) * z[1] - 3.0 * z[2]) / denominator;
    f[1] = exp(-z[1] * 0.3) * root + 1.0 / denominator - z[0];
    f[2] = S(2.5);
  }
};

/// f = (x^2 y, x sin y, x / z) with second derivatives that fit on a line.
struct TextbookField {
  template <class S>
  void operator()(const S* z, S* f) const {
    using std::sin;
    f[0] = z[0] * z[0] * z[1];
    f[1] = z[0] * sin(z[1]);
    f[2] = z[0] / z[2];
  }
};

std::array<double, dimension> random_state(std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  return {uniform(generator), uniform(generator), uniform(generator)};
}

TEST(DualDerivatives, JacobianAgreesWithComplexStep) {
  std::mt19937 generator(11);
  constexpr double h = 1e-200;
  for (int sample = 0; sample < 50; ++sample) {
    const auto z = random_state(generator);
    const auto result = ad::field_jacobian<dimension>(MixedField{}, z.data());
    for (std::size_t l = 0; l < dimension; ++l) {
      std::array<std::complex<double>, dimension> shifted{z[0], z[1], z[2]};
      std::array<std::complex<double>, dimension> f;
      shifted[l] += std::complex<double>(0.0, h);
      MixedField{}(shifted.data(), f.data());
      for (std::size_t i = 0; i < dimension; ++i) {
        EXPECT_NEAR(result.jacobian[i * dimension + l], f[i].imag() / h, 1e-13) << "entry " << i << ", " << l;
        EXPECT_NEAR(result.value[i], f[i].real(), 1e-14);
      }
    }
  }
}

TEST(DualDerivatives, ConstantComponentHasNoDerivatives) {
  const std::array<double, dimension> z{0.3, -0.7, 1.1};
  const auto first = ad::field_jacobian<dimension>(MixedField{}, z.data());
  for (std::size_t l = 0; l < dimension; ++l) EXPECT_EQ(first.jacobian[2 * dimension + l], 0.0);
  const std::array<double, dimension> weights{0.0, 0.0, 1.0};
  for (const double entry : ad::second_derivatives<dimension>(MixedField{}, z.data(), weights.data()))
    EXPECT_EQ(entry, 0.0);
}

TEST(DualDerivatives, SecondDerivativesAgreeWithClosedForm) {
  std::mt19937 generator(12);
  for (int sample = 0; sample < 20; ++sample) {
    const auto z = random_state(generator);
    const auto w = random_state(generator);
    const auto result = ad::second_derivatives<dimension>(TextbookField{}, z.data(), w.data());
    const double xx = 2.0 * w[0] * z[1];
    const double xy = 2.0 * w[0] * z[0] + w[1] * std::cos(z[1]);
    const double xz = -w[2] / (z[2] * z[2]);
    const double yy = -w[1] * z[0] * std::sin(z[1]);
    const double zz = 2.0 * w[2] * z[0] / (z[2] * z[2] * z[2]);
    const std::array<double, 9> expected{xx, xy, xz, xy, yy, 0.0, xz, 0.0, zz};
    for (std::size_t entry = 0; entry < 9; ++entry)
      EXPECT_NEAR(result[entry], expected[entry], 1e-14 * (1.0 + std::abs(expected[entry]))) << "entry " << entry;
  }
}

TEST(DualDerivatives, SecondDerivativesAreDerivativesOfTheJacobian) {
  // Central differences of order eight; at this h truncation and rounding are both below 1e-12.
  constexpr double h = 0.01;
  constexpr std::array<double, 4> stencil{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  std::mt19937 generator(13);
  for (int sample = 0; sample < 20; ++sample) {
    const auto z = random_state(generator);
    const auto w = random_state(generator);
    const auto result = ad::second_derivatives<dimension>(MixedField{}, z.data(), w.data());
    for (std::size_t m = 0; m < dimension; ++m) {
      for (std::size_t l = 0; l < dimension; ++l) {
        double difference = 0.0;
        for (std::size_t k = 0; k < stencil.size(); ++k) {
          auto above = z;
          auto below = z;
          above[m] += h * static_cast<double>(k + 1);
          below[m] -= h * static_cast<double>(k + 1);
          const auto upper = ad::field_jacobian<dimension>(MixedField{}, above.data()).jacobian;
          const auto lower = ad::field_jacobian<dimension>(MixedField{}, below.data()).jacobian;
          for (std::size_t i = 0; i < dimension; ++i)
            difference += w[i] * stencil[k] * (upper[i * dimension + l] - lower[i * dimension + l]) / h;
        }
        EXPECT_NEAR(result[l * dimension + m], difference, 1e-11);
        EXPECT_EQ(result[l * dimension + m], result[m * dimension + l]);
      }
    }
  }
}

TEST(DualDerivatives, GradientAgreesWithClosedForm) {
  const auto function = []<class S>(const S* z) -> S {
    using std::cos;
    return z[0] * z[0] * cos(z[1]) + 4.0;
  };
  const std::array<double, 2> z{1.25, -0.5};
  const auto result = ad::value_gradient<2>(function, z.data());
  EXPECT_DOUBLE_EQ(result.value, z[0] * z[0] * std::cos(z[1]) + 4.0);
  EXPECT_DOUBLE_EQ(result.gradient[0], 2.0 * z[0] * std::cos(z[1]));
  EXPECT_DOUBLE_EQ(result.gradient[1], -z[0] * z[0] * std::sin(z[1]));
}

TEST(DualDerivatives, OneDimensionWorks) {
  const auto field = []<class S>(const S* z, S* f) { f[0] = z[0] * z[0] * z[0]; };
  const double z = 2.0;
  const double weight = 3.0;
  EXPECT_EQ(ad::field_jacobian<1>(field, &z).jacobian[0], 12.0);
  EXPECT_EQ(ad::second_derivatives<1>(field, &z, &weight)[0], 36.0);
}

}  // namespace
}  // namespace derivatives_test
