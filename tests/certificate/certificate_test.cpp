#include "orbweaver/certificate/certificate.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "certificate/decay.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::certificate::certificate_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double pi = std::numbers::pi;
constexpr double omega = 1.7;

std::shared_ptr<const systems::System> oscillator() {
  return systems::make_system("harmonic_oscillator", {{"omega", omega}});
}

/// q = cos s, p = -omega sin s: an orbit when `period` is 2 pi / omega.
loop::Loop oscillation(double period) {
  const std::vector<double> origin{0.0, 0.0};
  loop::Loop loop = loop::constant_loop(origin, period, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 1) = -omega;
  return loop;
}

/// The exact flow of the oscillator, from q = cos(phase), p = -omega sin(phase).
double distance_to_flow(double phase, double time, double next_phase) {
  return std::hypot(std::cos(phase + omega * time) - std::cos(next_phase),
                    omega * (std::sin(phase + omega * time) - std::sin(next_phase)));
}

TEST(Certificate, AcceptsAnExactOrbit) {
  const Certificate certificate = certify(*oscillator(), oscillation(2.0 * pi / omega));
  EXPECT_LT(certificate.closure, 5e-14);
  EXPECT_LT(certificate.single_shot, 1e-12);
  EXPECT_LT(certificate.energy_drift, 5e-15);
}

/// A rotator whose orbits turn with 1 + shear (I - 1/2), I = (q^2 + p^2)/2; q = cos t, p = -sin t is one. Conserved is
/// 3 (I + shear (I - 1/2)^2 / 2).
class ShearedRotator final : public test::PointSystem {
 public:
  explicit ShearedRotator(double shear) : PointSystem(test::structure_of(2, true)), _shear(shear) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return rate(z) * Eigen::Vector2d(z(1), -z(0));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix2d turn;
    turn << 0.0, rate(z), -rate(z), 0.0;
    return turn + _shear * Eigen::Vector2d(z(1), -z(0)) * z.transpose();
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override { return 3.0 * rate(z) * z; }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    const double more = 0.5 * (z[0] * z[0] + z[1] * z[1]) - 0.5;
    return 3.0 * (more + 0.5 + 0.5 * _shear * more * more);
  }

 private:
  [[nodiscard]] double rate(const Eigen::VectorXd& z) const { return 1.0 + _shear * (0.5 * z.squaredNorm() - 0.5); }
  double _shear;
};

// Displaced by delta along dH/dz an orbit turns by 2 pi shear delta further: once around it is
// sqrt(1 + (2 pi shear)^2) delta off.
TEST(Certificate, MeasuresHowAnErrorOfTheEnergyGrows) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 2.0 * pi, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 1) = -1.0;
  for (const double shear : {1e5, 1e6}) {
    loop::Loop longer = loop;
    longer.period += 1e-8;  // an orbit that returns to rounding is not asked
    const Certificate found = certify(ShearedRotator(shear), longer);
    EXPECT_NEAR(found.displaced_growth / std::hypot(1.0, 2.0 * pi * shear), 1.0, 0.02) << shear;
  }
  EXPECT_TRUE(std::isnan(certify(ShearedRotator(0.0), loop).displaced_growth)) << "it returns to rounding";
}

/// x'' = -x + x^3: orbits between its two saddles are x = A sn(w t, k), w^2 (1 + k^2) = 1, A^2 = 2 k^2 w^2.
class SofteningSpring final : public test::PointSystem {
 public:
  SofteningSpring() : PointSystem(test::structure_of(2, true)) {}
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(z(1), -z(0) + z(0) * z(0) * z(0));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    return Eigen::Matrix2d{{0.0, 1.0}, {-1.0 + 3.0 * z(0) * z(0), 0.0}};
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(z(0) - z(0) * z(0) * z(0), z(1));
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[1] * z[1] + z[0] * z[0]) - 0.25 * z[0] * z[0] * z[0] * z[0];
  }

  /// From its turning point, with 1 - k^2 = `beside`: by the series of sn in the nome.
  [[nodiscard]] static loop::Loop orbit(double beside) {
    const double k = std::sqrt(1.0 - beside);
    const double quarter = std::comp_ellint_1(k);
    const double w = 1.0 / std::sqrt(1.0 + k * k);
    const double nome = std::exp(-pi * std::comp_ellint_1(std::sqrt(beside)) / quarter);
    loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 4.0 * quarter / w, 255);
    for (int n = 0; 2 * n + 1 <= loop.cutoff; ++n) {
      const int h = 2 * n + 1;
      const double part = std::sqrt(2.0) * w * 2.0 * pi / quarter * std::pow(nome, n + 0.5) / (1.0 - std::pow(nome, h));
      const double sign = n % 2 == 0 ? 1.0 : -1.0;  // a quarter later than sn
      loop.cosine(h, 0) = sign * part;
      loop.sine(h, 1) = -sign * part * h * 2.0 * pi / loop.period;
    }
    return loop;
  }
};

// Where it begins, near a saddle, the energy hardly changes with the state: an error that is made halfway between the
// saddles changes the period by far more.
TEST(Certificate, AnErrorOnTheWayChangesThePeriodBesideASaddle) {
  for (const double beside : {1e-4, 1e-5}) {
    const loop::Loop loop = SofteningSpring::orbit(beside);
    const Certificate found = certify(SofteningSpring(), loop);
    EXPECT_LT(found.closure, 1e-12);
    EXPECT_EQ(judge(found, {.period = loop.period, .residual = 1e-15, .amplitude = 1.0, .growth = 2.0}).verdict,
              Verdict::holds)
        << found.single_shot << ", a displacement grows by " << found.displaced_growth;
    EXPECT_GT(found.displaced_growth, 1.0 / beside);
    const Certificate known = Certifier(SofteningSpring(), {})(loop, 1e9);
    EXPECT_TRUE(std::isnan(known.displaced_growth)) << "the growth that is known explains it";
  }
}

/// r = cos(phase), an orbit beside which others part like exp(strength sin(phase)): not at all once around.
class RepellingHalfWay final : public test::PointSystem {
 public:
  explicit RepellingHalfWay(double strength) : PointSystem(turning()), _strength(strength) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(_strength * std::cos(z(1)) * (z(0) - std::cos(z(1))) - std::sin(z(1)), 1.0);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const double off = z(0) - std::cos(z(1));
    Eigen::Matrix2d jacobian;
    jacobian << _strength * std::cos(z(1)), _strength * std::sin(z(1)) * (std::cos(z(1)) - off) - std::cos(z(1)), 0.0,
        0.0;
    return jacobian;
  }

 private:
  static systems::Structure turning() {
    systems::Structure structure = test::structure_of(2);
    structure.angles = {1};
    return structure;
  }
  double _strength;
};

// It begins where others are farthest: what is displaced there comes back to it by then.
TEST(Certificate, MeasuresHowAnErrorOnTheWayGrows) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.5 * pi}, 2.0 * pi, 3);
  loop.sine(1, 0) = -1.0;
  loop.winding = {0, 1};
  for (const double strength : {8.0, 10.0}) {
    const Certificate found = certify(RepellingHalfWay(strength), loop);
    EXPECT_LT(found.closure, 1e-9);
    EXPECT_NEAR(found.displaced_growth / std::exp(2.0 * strength), 1.0, 0.1) << strength;
    EXPECT_EQ(judge(found, {.period = 2.0 * pi, .residual = 1e-15, .amplitude = 1.0, .growth = 1.0}).verdict,
              Verdict::holds);
  }
}

TEST(Certificate, IsThatOfTheOrbitUnderAnyTimeMap) {
  for (const loop::TimeMap& map : {loop::TimeMap{2.0, {}}, loop::TimeMap{1.2, {0.2, -0.1}}}) {
    const loop::Loop mapped = loop::with_time_map(oscillation(2.0 * pi / omega), map, 120);
    EXPECT_LT(certify(*oscillator(), mapped).closure, 5e-14);
    EXPECT_LT(certify(*oscillator(), mapped).energy_drift, 5e-14);
    const double off = certify(*oscillator(), oscillation(3.0)).closure;
    EXPECT_NEAR(certify(*oscillator(), loop::with_time_map(oscillation(3.0), map, 120)).closure, off, 1e-12);
    ASSERT_GT(off, 0.01);
  }
}

TEST(Closures, AgreeWhetherTheLoopIsAnOrbitOrNot) {
  for (const double period : {2.0 * pi / omega, 3.0}) {
    const Certificate found = certify(*oscillator(), oscillation(period));
    EXPECT_NEAR(found.taylor_closure, found.closure, 1e-13);
    EXPECT_LT(found.apart, 1e-13);
  }
}

// A tolerance of 1e-6 for the one leaves it that far from the other, which has none.
TEST(Closures, SayHowFarTheIntegratorsAreApart) {
  const auto system = systems::make_system("double_pendulum");
  const std::vector<double> hanging{0.3, -0.2, 0.1, 0.0};
  loop::Loop loop = loop::constant_loop(hanging, 6.0, 3);
  loop.cosine(1, 0) = 1.0;
  loop.sine(1, 2) = -1.0;
  Options options;
  options.segments = 4;
  const Certificate fine = certify(*system, loop, {}, options);
  EXPECT_LT(fine.apart, 1e-11);
  EXPECT_GT(fine.taylor_closure, 0.1);
  options.tolerance = 1e-6;
  const Certificate coarse = certify(*system, loop, {}, options);
  EXPECT_EQ(coarse.taylor_closure, fine.taylor_closure);
  EXPECT_GT(coarse.apart, 1e-9);
  EXPECT_GE(coarse.apart, std::abs(coarse.taylor_closure - coarse.closure));
}

TEST(Closures, AreThoseOfTheSystemInItsScales) {
  const auto plain = systems::make_system("double_pendulum");
  systems::Scales scales{2.0, {1.0, 1.0, 0.25, 0.25}, {8.0}, {}};
  const std::vector<double> hanging{0.3, -0.2, 0.1, 0.0};
  const loop::Loop loop = loop::constant_loop(hanging, 3.0, 3);
  const Certificate told = certify(*systems::scaled(plain, scales), loop);
  EXPECT_GT(told.taylor_closure, 0.01);
  EXPECT_LT(told.apart, 1e-12);
}

TEST(Closures, OfTaylorSeriesNeedFormulas) {
  const loop::Loop still = loop::constant_loop(std::vector<double>{1.0}, 1.0, 3);
  const Certificate found = certify(Decay(1.0), still);
  EXPECT_GT(found.closure, 0.01);
  EXPECT_TRUE(std::isnan(found.taylor_closure));
  EXPECT_TRUE(std::isnan(found.apart));
}

TEST(Certificate, OfNoLevelSaysNothing) {
  const Certificate found = certify(*oscillator(), oscillation(3.0), {}, {.level = Level::none});
  EXPECT_TRUE(std::isnan(found.closure));
  EXPECT_TRUE(std::isnan(found.energy_drift));
}

// q = cos s + a cos 3 s with a period of its first harmonic: an orbit at a distance of 3 a omega or so.
TEST(Certificate, EstimatesTheDistanceToTheOrbit) {
  for (const double a : {1e-3, 1e-6}) {
    loop::Loop loop = oscillation(2.0 * pi / omega);
    loop.cosine(3, 0) = a;
    const Certificate found = certify(*oscillator(), loop, {}, {.level = Level::full});
    EXPECT_GT(found.distance, 0.5 * a);
    EXPECT_LT(found.distance, 4.0 * a);
    EXPECT_LT(found.contraction, 1e-3);
    EXPECT_LT(found.pairing, 1e-9);
  }
}

TEST(Certificate, FindsAnOrbitGoneAroundSeveralTimes) {
  EXPECT_GT(certify(*oscillator(), oscillation(2.0 * pi / omega)).recurrence, 0.1);
  for (const int times : {2, 3, 5, 6}) {
    const loop::Loop around = loop::repeated(oscillation(2.0 * pi / omega), times);
    EXPECT_LT(certify(*oscillator(), around).recurrence, 1e-12) << times;
  }
}

TEST(Certificate, MeasuresHowFarALoopIsFromAnOrbit) {
  constexpr double period = 2.0 * pi / omega * 1.01;
  constexpr int segments = 8;
  const Certificate certificate = certify(*oscillator(), oscillation(period), {}, {.segments = segments});
  double expected = 0.0;
  for (int m = 0; m < segments; ++m)
    expected =
        std::max(expected, distance_to_flow(2.0 * pi * m / segments, period / segments, 2.0 * pi * (m + 1) / segments));
  EXPECT_NEAR(certificate.closure, expected, 1e-12);
  EXPECT_NEAR(certificate.single_shot, distance_to_flow(0.0, period, 0.0), 1e-12);
  EXPECT_GT(certificate.single_shot, 0.05);
}

TEST(Certificate, SeesAnErrorAnywhereOnTheLoop) {
  // A ripple that vanishes at t = 0, T / 4, T / 2 and 3 T / 4 stays unseen with four segments, not with sixteen.
  loop::Loop loop = oscillation(2.0 * pi / omega);
  loop = loop::with_cutoff(loop, 4);
  loop.sine(4, 0) = 1e-6;
  EXPECT_LT(certify(*oscillator(), loop, {}, {.segments = 4}).closure, 1e-12);
  const double carried_on = 1e-6 * std::hypot(std::cos(pi / 8.0), omega * std::sin(pi / 8.0));
  EXPECT_NEAR(certify(*oscillator(), loop, {}, {.segments = 16}).closure, carried_on, 1e-12);
}

TEST(Certificate, OneSegmentIsASingleShot) {
  const Certificate certificate = certify(*oscillator(), oscillation(3.0), {}, {.segments = 1});
  EXPECT_EQ(certificate.closure, certificate.single_shot);
}

TEST(Certificate, MeasuresEnergyAlongTheLoop) {
  loop::Loop loop = oscillation(2.0 * pi / omega);
  loop.sine(1, 1) *= 1.001;
  const double expected = 0.5 * omega * omega * (1.001 * 1.001 - 1.0);
  EXPECT_NEAR(certify(*oscillator(), loop, {}, {.segments = 8}).energy_drift, expected, 1e-15);
}

TEST(Certificate, AnglesMayTurnOver) {
  // Without gravity the stretched pendulum rotates uniformly: th1 = th2 = 3 t.
  const auto system = systems::make_system("double_pendulum", {{"m1", 1.3}, {"l2", 0.6}, {"g", 1e-30}});
  const std::vector<double> start{0.4, 0.4, 3.0, 3.0};
  for (const double turns : {1.0, 2.0}) {
    loop::Loop loop = loop::constant_loop(start, turns * 2.0 * pi / 3.0, 2);
    loop.winding = {turns, turns, 0.0, 0.0};
    const Certificate certificate = certify(*system, loop);
    EXPECT_LT(certificate.closure, 5e-14);
    EXPECT_LT(certificate.single_shot, 5e-12);
    EXPECT_LT(certificate.energy_drift, 1e-13);
    loop.winding = {0.0, 0.0, 0.0, 0.0};
    EXPECT_NEAR(certify(*system, loop).single_shot, turns * 2.0 * pi * std::numbers::sqrt2, 1e-10);
  }
}

TEST(Certificate, SystemsWithoutEnergyHaveNoDrift) {
  const std::vector<double> rest{0.0};
  const Certificate certificate = certify(Decay(1.0), loop::constant_loop(rest, 2.0, 1));
  EXPECT_EQ(certificate.closure, 0.0);
  EXPECT_TRUE(std::isnan(certificate.energy_drift));
}

TEST(Certificate, FailureNamesTheSegmentAndTheTime) {
  const std::vector<double> mean{1.0};
  loop::Loop loop = loop::constant_loop(mean, 4.0, 1);
  loop.cosine(1, 0) = 0.5;  // z = 1.5, 1, 0.5, 1 at the quarters
  EXPECT_THAT(([&] { (void)certify(Decay(0.1, 0.49), loop, {}, {.segments = 4}); }),
              ThrowsMessage<core::NumericalError>(AllOf(HasSubstr("segment 3 of 4"), HasSubstr("period 4 (from t = 2)"),
                                                        HasSubstr("stopped at t = 0.2"))));
}

TEST(Certificate, MisuseIsRefused) {
  EXPECT_THAT(([] { (void)certify(Decay(1.0), oscillation(1.0)); }),
              ThrowsMessage<core::MisuseError>(HasSubstr("same dimension")));
  EXPECT_THAT(([] { (void)certify(*oscillator(), oscillation(1.0), {}, {.segments = 0}); }),
              ThrowsMessage<core::MisuseError>(HasSubstr("at least one segment")));
  loop::Loop broken = oscillation(1.0);
  broken.cosine(1, 0) = std::nan("");
  EXPECT_THAT(([&] { (void)certify(*oscillator(), broken); }), ThrowsMessage<core::MisuseError>(HasSubstr("finite")));
}

}  // namespace
}  // namespace orbweaver::certificate::certificate_test
