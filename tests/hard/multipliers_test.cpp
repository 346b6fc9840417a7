// Multipliers to 1e18 and past what a double holds, beside an orbit whose own motion is mild.
#include <cmath>
#include <numbers>

#include "continuation/families.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "spectrum/point_systems.hpp"

namespace multipliers_test {
namespace {

using namespace orbweaver;

constexpr double pi = std::numbers::pi;

/// q'' = -q - q^3 beside x'' = rate^2 x, state q, p, x, y: along the orbits in the plane x = y = 0, of any period T,
/// the multipliers are exp(+-rate T).
class BesideASaddle final : public test::PointSystem {
 public:
  explicit BesideASaddle(double rate) : PointSystem(described()), _rate(rate) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector4d(z[1], -z[0] * (1.0 + z[0] * z[0]), _rate * z[3], _rate * z[2]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = 1.0;
    a(1, 0) = -1.0 - 3.0 * z[0] * z[0];
    a(2, 3) = a(3, 2) = _rate;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector4d(z[0] * (1.0 + z[0] * z[0]), z[1], -_rate * z[2], _rate * z[3]);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[0] * z[0] + z[1] * z[1] + _rate * (z[3] * z[3] - z[2] * z[2])) + 0.25 * std::pow(z[0], 4);
  }

 private:
  static systems::Structure described() {
    systems::Structure d = test::structure_of(4, true, true);
    d.equivariances = {{"S", -Eigen::Matrix4d::Identity()}};
    d.reversors = {{"R", Eigen::Matrix4d(Eigen::Vector4d(1, -1, 1, -1).asDiagonal())}};
    return d;
  }
  double _rate;
};

/// The orbit from rest at q = 1: T = 4 K(m)/sqrt 2 with m = 1/4, by the arithmetic-geometric mean.
double exact_period() {
  long double a = 1;
  long double b = std::sqrt(0.75L);
  for (int n = 0; n < 10; ++n) {
    const long double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return static_cast<double>(4 * (test::reference::pi / (2 * a)) / std::sqrt(2.0L));
}

loop::Loop orbit_beside(const std::shared_ptr<const BesideASaddle>& system, const loop::Isotropy& isotropy,
                        const loop::Loop& mode) {
  continuation::Options options;
  options.energy_to = 0.75;  // q = 1 at rest
  const test::Trace trace = test::trace_of(
      system, {loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * pi, 8), {mode.modes}, isotropy}, options);
  EXPECT_EQ(trace.ending.reason, continuation::EndReason::energy_limit) << trace.ending.text();
  return trace.last().loop;
}

class Multipliers : public testing::TestWithParam<double> {};

TEST_P(Multipliers, BesideASaddle) {
  const double exponent = GetParam();  // log10 of the largest multiplier
  const double period = exact_period();
  const double rate = exponent * std::log(10.0) / period;
  const std::string name = fmt::format("multiplier 1e{:.0f}", exponent);
  const auto system = std::make_shared<const BesideASaddle>(rate);
  loop::Loop mode = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * pi, 8);
  mode.cosine(1, 0) = 1.0;
  mode.sine(1, 1) = -1.0;
  const loop::Isotropy isotropy = loop::find_isotropy(system->structure(), mode, 1e-9);
  test::HardCase row(name, "T of q'' = -q - q^3 from q = 1, relative");
  const loop::Loop orbit = orbit_beside(system, isotropy, mode);
  row.within(std::abs(orbit.period - period) / period, 1e-12);
  // Of the half map, with which x changes its sign: -2 cosh(rate T/2); of the period: 2 cosh(rate T).
  const double half = -2.0 * std::cosh(0.5 * rate * period);
  const double full = 2.0 * std::cosh(rate * period);
  test::HardCase index(name, "index 2 cosh(T rate), relative");
  if (std::isfinite(half)) {
    const spectrum::Stability stability = spectrum::floquet(*system, orbit, isotropy);
    ASSERT_EQ(stability.fundamental_order, 2);
    if (std::isfinite(full)) {
      index.within(std::abs(stability.full.at(0).real() / full - 1.0), 1e-9);
    } else {
      index.is(std::isnan(stability.full.at(0).real()) && std::isnan(stability.full_error.at(0)), "beyond range",
               fmt::format("{}", stability.full.at(0).real()));
    }
    const double found = stability.fundamental.at(0).real();
    test::HardCase(name, "of the half map, -2 cosh(T/2 rate), relative").within(std::abs(found / half - 1.0), 1e-9);
    test::HardCase(name, "error in parts of its own bound")
        .within(std::abs(found - half) / stability.fundamental_error.at(0), 1.0);
    EXPECT_LT(stability.fundamental_error.at(0), 1e-6 * std::abs(half)) << "the bound says nothing";
  } else {
    std::string said = "a number";
    try {
      (void)spectrum::floquet(*system, orbit, isotropy);
    } catch (const core::NotFiniteError& error) {
      said = std::string(error.what()).find("beyond double precision's range") == std::string::npos ? error.what()
                                                                                                    : "beyond range";
    }
    index.is(said == "beyond range", "beyond range", said);
  }
  // What the integration says of an exact orbit, the judgement may not call a contradiction.
  const certificate::Certificate certificate = certificate::certify(*system, orbit);
  const double growth = std::exp(std::min(rate * period, 700.0));
  const certificate::Judgement judgement =
      certificate::judge(certificate, {orbit.period, 1e-10, loop::rms_amplitude(orbit), growth});
  test::HardCase(name, "the certificate of an exact orbit")
      .is(judgement.verdict == certificate::Verdict::holds || judgement.verdict == certificate::Verdict::says_nothing,
          "no contradiction", fmt::format("closure {:.1e}", certificate.closure));
}

INSTANTIATE_TEST_SUITE_P(Hard, Multipliers, testing::Values(18.0, 100.0, 300.0, 320.0, 700.0));

}  // namespace
}  // namespace multipliers_test
