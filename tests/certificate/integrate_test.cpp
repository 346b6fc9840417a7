#include "orbweaver/certificate/integrate.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "certificate/decay.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::certificate::integrate_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// How far the integrated oscillator q = cos(omega t) is from the exact one.
double oscillator_error(double time, double tolerance) {
  constexpr double omega = 1.5;
  const auto system = systems::make_system("harmonic_oscillator", {{"omega", omega}});
  const auto end = integrate(*system, {1.0, 0.0}, time, tolerance);
  return std::hypot(end[0] - std::cos(omega * time), end[1] + omega * std::sin(omega * time));
}

double number_after(const std::string& text, const std::string& label) {
  return std::stod(text.substr(text.find(label) + label.size()));
}

TEST(Integrate, ReachesTheExactOscillator) {
  for (const double time : {1e-6, 0.1, 1.0, 7.3, 20.0, -3.0}) EXPECT_LT(oscillator_error(time, 1e-13), 2e-12) << time;
}

TEST(Integrate, SmallStatesKeepTheirDigits) {
  const auto system = systems::make_system("harmonic_oscillator", {{"omega", 1.5}});
  for (const double size : {1e-6, 1e-12}) {
    const auto end = integrate(*system, {size, 0.0}, 20.0, 1e-13);
    EXPECT_NEAR(end[0] / size, std::cos(30.0), 2e-12) << size;
  }
}

TEST(Integrate, ErrorFollowsTheTolerance) {
  // Steps grow like tolerance^(1/8), each with an error of the tolerance: a global error like tolerance^(7/8) to
  // tolerance.
  const double coarse = oscillator_error(20.0, 1e-5);
  const double middle = oscillator_error(20.0, 1e-8);
  const double fine = oscillator_error(20.0, 1e-11);
  for (const double ratio : {coarse / middle, middle / fine}) {
    EXPECT_GT(std::log10(ratio), 3.0 * 0.8);
    EXPECT_LT(std::log10(ratio), 3.0 * 1.15);
  }
  EXPECT_LT(fine, 20.0 * 20.0 * 1e-11);
}

TEST(Integrate, ChaoticOrbitComesBackInReversedTime) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> start{2.0, 1.5, 0.1, -0.3};
  const auto end = integrate(*system, start, 5.0, 1e-13);
  const auto back = integrate(*system, end, -5.0, 1e-13);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(back[i], start[i], 1e-10);
  EXPECT_NEAR(system->conserved(0, end), system->conserved(0, start), 2e-12);
  EXPECT_GT(std::abs(end[0] - start[0]), 0.1);
}

TEST(Integrate, EqualCallsGiveEqualBits) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<double> start{0.1, 0.2, 0.3, -0.1};
  EXPECT_EQ(integrate(*system, start, 30.0, 1e-13), integrate(*system, start, 30.0, 1e-13));
}

TEST(Integrate, RestAndNoTimeChangeNothing) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> rest(4, 0.0);
  const std::vector<double> moving{0.3, 0.1, 0.0, 2.0};
  EXPECT_EQ(integrate(*system, rest, 12.0, 1e-13), rest);
  EXPECT_EQ(integrate(*system, moving, 0.0, 1e-13), moving);
}

TEST(Integrate, NanInTheStateIsReportedAtTheStart) {
  const auto system = systems::make_system("harmonic_oscillator");
  EXPECT_THAT(([&] {
                (void)integrate(*system, {std::nan(""), 0.0}, 1.0, 1e-12);
              }),
              ThrowsMessage<core::NumericalError>(
                  AllOf(HasSubstr("'harmonic_oscillator'"), HasSubstr("t = 0:"), HasSubstr("not finite"))));
}

TEST(Integrate, NanOfTheFieldIsReportedWhereItIsMet) {
  const Decay decay(1.0, 0.5);
  EXPECT_NEAR(integrate(decay, {1.0}, 0.69, 1e-12)[0], std::exp(-0.69), 1e-11);
  try {
    (void)integrate(decay, {1.0}, 2.0, 1e-12);
    FAIL() << "the wall at z = 0.5 was passed";
  } catch (const core::NumericalError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'decay'"), HasSubstr("not finite")));
    EXPECT_NEAR(number_after(error.what(), "t = "), std::numbers::ln2, 1e-9);
  }
}

TEST(Integrate, EscapeToInfinityIsReportedWhereItHappens) {
  const auto system = systems::make_system("henon_heiles");
  // On the axis x = 0 with energy 2/3 the time to infinity is the integral of dy / sqrt(4/3 - y^2 + 2 y^3 / 3) from 1.
  constexpr double escape_time = 2.8396136988958938;
  const std::vector<double> start{0.0, 1.0, 0.0, 1.0};
  EXPECT_GT(integrate(*system, start, escape_time - 0.01, 1e-12)[1], 1e4);
  try {
    (void)integrate(*system, start, 50.0, 1e-12);
    FAIL() << "an orbit that reaches infinity was integrated to the end";
  } catch (const core::NumericalError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'henon_heiles'"));
    EXPECT_NEAR(number_after(error.what(), "t = "), escape_time, 1e-8);
  }
}

TEST(Integrate, StepLimitIsReportedWithTheTimeReached) {
  const auto system = systems::make_system("harmonic_oscillator");
  EXPECT_THAT(([&] {
                (void)integrate(*system, {1.0, 0.0}, 1e12, 1e-13);
              }),
              ThrowsMessage<core::NumericalError>(AllOf(HasSubstr("limit of a million steps"),
                                                        HasSubstr("over a time of 1000000000000"), HasSubstr("t = "))));
}

TEST(Integrate, StatesTogetherEndWhereEachEnds) {
  const auto system = systems::make_system("double_pendulum");
  std::vector<std::vector<double>> states;
  for (int n = 0; n < 7; ++n) states.push_back({0.3 * n, 0.1, -0.2 * n, 0.5});
  const auto ends = integrate_together(*system, states, 2.0, 1e-13);
  for (std::size_t n = 0; n < states.size(); ++n) {
    const auto alone = integrate(*system, states[n], 2.0, 1e-13);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(ends[n][i], alone[i], 1e-11) << n;
  }
}

TEST(Integrate, TransitionsAreTheDerivativesOfTheFlow) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<std::vector<double>> states{{1.2, 0.1, -0.2, 0.5}, {0.1, 0.0, 0.3, 0.0}, {2.0, 1.0, 0.0, 0.0}};
  const auto matrices = transitions(*system, states, 1.5, 1e-12);
  constexpr double h = 1e-5;
  for (std::size_t n = 0; n < states.size(); ++n)
    for (std::size_t c = 0; c < 4; ++c) {
      auto plus = states[n];
      auto minus = states[n];
      plus[c] += h;
      minus[c] -= h;
      plus = integrate(*system, plus, 1.5, 1e-13);
      minus = integrate(*system, minus, 1.5, 1e-13);
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(matrices[n][i * 4 + c], (plus[i] - minus[i]) / (2.0 * h), 1e-7 * (1.0 + std::abs(plus[i] / h) * h));
    }
}

TEST(Integrate, MisuseIsRefused) {
  const auto system = systems::make_system("harmonic_oscillator");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(([&] { (void)integrate(*system, {1.0}, 1.0, 1e-12); }),
              ThrowsMessage<core::MisuseError>(HasSubstr("one number a coordinate")));
  EXPECT_THAT(([&] {
                (void)integrate(*system, {1.0, 0.0}, infinity, 1e-12);
              }),
              ThrowsMessage<core::MisuseError>(HasSubstr("time to integrate over must be finite")));
  for (const double tolerance : {0.0, -1e-3, 1e-16, 0.2, std::nan("")})
    EXPECT_THAT(([&] {
                  (void)integrate(*system, {1.0, 0.0}, 1.0, tolerance);
                }),
                ThrowsMessage<core::MisuseError>(HasSubstr("[1e-15, 0.1]")));
}

}  // namespace
}  // namespace orbweaver::certificate::integrate_test
