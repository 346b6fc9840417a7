// Orbits within 1e-8 of each kind of crossing, on both sides of it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bifurcation/crossings.hpp"
#include "bifurcation/plane_family.hpp"
#include "bifurcation/sweep.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "survey/atlas.hpp"

namespace crossings_test {
namespace {

using namespace orbweaver;

using test::reference::Point;
using test::reference::Real;

constexpr double beside = 1e-8;

/// k - c at the orbit of the family with this period.
struct Place {
  double deviation = 0.0;
  double error = 0.0;
  double broken = 0.0;  ///< how far it is from its family's symmetries
};
Place place_of(const test::Trace& family, double period, double c) {
  const corrector::Result orbit = test::orbit_at(family, period);
  EXPECT_TRUE(orbit.converged()) << orbit.detail;
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  const spectrum::Stability stability = spectrum::floquet(*test::pendulum(), orbit.loop, isotropy);
  Place place{stability.fundamental.at(0).real() - c, stability.fundamental_error.at(0), 0.0};
  for (const loop::SymmetryElement& element : isotropy)
    place.broken = test::worse(place.broken, loop::symmetry_defect(orbit.loop, element, {0, 1}));
  return place;
}

struct Known {
  std::string kind;
  test::PendulumMode mode;
  double period;  ///< by an extrapolation method in Python (mpmath), to 25 digits and more
  double index;   ///< of the half map there
};

class BothSides : public testing::TestWithParam<Known> {};

// The index passes c between T - 1e-8 and T + 1e-8, T being known from elsewhere, with the slope that it has beyond;
// the orbits stay those of the family, though another one is 1e-4 away (the amplitude of what is born grows as a root).
TEST_P(BothSides, OfAZeroOfTheIndex) {
  const Known& known = GetParam();
  const test::Trace& family = test::family_to_twelve(known.mode);
  const std::string name = fmt::format("{}, {} at T = {:.6f}, T -+ 1e-8", known.mode.name, known.kind, known.period);
  test::HardCase row(name, "k passes c between: signs differ, beyond the errors");
  const Place before = place_of(family, known.period - beside, known.index);
  const Place after = place_of(family, known.period + beside, known.index);
  row.is(before.deviation * after.deviation < 0.0 && std::abs(before.deviation) > before.error &&
             std::abs(after.deviation) > after.error,
         "signs differ", fmt::format("{:.1e}, {:.1e}", before.deviation, after.deviation));
  const double far = 1e-3;
  const double slope = (place_of(family, known.period + far, known.index).deviation -
                        place_of(family, known.period - far, known.index).deviation) /
                       (2.0 * far);
  test::HardCase(name, "k - c as its slope over T -+ 1e-3 says")
      .within(std::max(std::abs(after.deviation - slope * beside), std::abs(before.deviation + slope * beside)), 1e-9);
  test::HardCase(name, "the family's symmetries").within(test::worse(before.broken, after.broken), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Hard, BothSides,
                         testing::Values(Known{"period doubling", test::in_phase(), 8.442930704977588405, 0.0},
                                         Known{"branch point", test::in_phase(), 10.416773281973249, 2.0},
                                         Known{"subharmonic (3)", test::in_phase(), 10.180534055738, 1.0},
                                         Known{"period doubling", test::out_phase(), 4.059557792801163, 0.0},
                                         Known{"subharmonic (3)", test::out_phase(), 5.177415388176, 1.0},
                                         Known{"branch point", test::out_phase(), 6.147515349731, 2.0}));

/// q'' = -V'(q), V = q^2/2 + a q^4/4 + b q^6/6 with a < 0 < b: T grows at first, and has a maximum.
class Oscillator final : public test::PointSystem {
 public:
  static constexpr double a = -0.5;
  static constexpr double b = 0.2;

  Oscillator() : PointSystem(described()) {}
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const double square = z[0] * z[0];
    return Eigen::Vector2d(z[1], -z[0] * (1.0 + square * (a + b * square)));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const double square = z[0] * z[0];
    Eigen::Matrix2d out;
    out << 0.0, 1.0, -1.0 - square * (3.0 * a + 5.0 * b * square), 0.0;
    return out;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    const double square = z[0] * z[0];
    return Eigen::Vector2d(z[0] * (1.0 + square * (a + b * square)), z[1]);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    const double square = z[0] * z[0];
    return 0.5 * z[1] * z[1] + square * (0.5 + square * (a / 4.0 + b * square / 6.0));
  }
  /// T of the orbit from rest at A: with q = A sin u, 2 (V(A) - V(q)) = A^2 cos^2 u g(u); the mean of g^(-1/2) over u.
  [[nodiscard]] static Real period(Real reach) {
    constexpr int nodes = 400;
    Real sum = 0;
    for (int n = 0; n < nodes; ++n) {
      const Real s = std::sin(2 * test::reference::pi * n / nodes);
      const Real x = reach * reach;
      const Real y = x * s * s;
      sum += 1 / std::sqrt(1 + Real(a) / 2 * (x + y) + Real(b) / 3 * (x * x + x * y + y * y));
    }
    return 2 * test::reference::pi * sum / nodes;
  }
  static loop::Loop small_oscillation() {
    loop::Loop loop = loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, 8);
    loop.cosine(1, 0) = 1.0;
    loop.sine(1, 1) = -1.0;
    return loop;
  }
  static systems::Structure described() {
    systems::Structure d = test::structure_of(2, true, true);
    d.equivariances = {{"S", -Eigen::Matrix2d::Identity()}};
    d.reversors = {{"R", Eigen::Matrix2d(Eigen::Vector2d(1, -1).asDiagonal())}};
    return d;
  }
};

// Below its maximum T belongs to two orbits, at A_f -+ sqrt(2 dT/|T''|), at it to one and above to none.
TEST(Folds, InThePeriod) {
  const auto system = std::make_shared<const Oscillator>();
  const Real h = 1e-5L;
  const auto slope = [&](Real reach) {
    return (8 * (Oscillator::period(reach + h) - Oscillator::period(reach - h)) -
            (Oscillator::period(reach + 2 * h) - Oscillator::period(reach - 2 * h))) /
           (12 * h);
  };
  const Real fold = test::reference::zero_between(slope, 1.8L, 0.5L);
  const Real longest = Oscillator::period(fold);
  continuation::Options options;
  options.energy_to = 4.0;
  const loop::Isotropy isotropy = loop::find_isotropy(system->structure(), Oscillator::small_oscillation(), 1e-9);
  const test::Trace family =
      test::trace_of(system,
                     {loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, 8),
                      {Oscillator::small_oscillation().modes},
                      isotropy},
                     options);
  ASSERT_EQ(family.ending.reason, continuation::EndReason::energy_limit) << family.ending.text();
  double worst = 0.0;
  for (const continuation::Orbit& orbit : family.orbits) {
    const Real exact = Oscillator::period(std::abs(loop::state_at(orbit.loop, 0.0)[0]));
    worst = test::worse(worst, static_cast<double>(std::abs(orbit.loop.period - exact)));
  }
  test::HardCase("a family around a fold in T", "T(A) by quadrature, all orbits").within(worst, 1e-11);
  const auto nearest = std::min_element(family.orbits.begin(), family.orbits.end(), [&](const auto& x, const auto& y) {
    const auto away = [&](const continuation::Orbit& orbit) {
      return std::abs(std::abs(loop::state_at(orbit.loop, 0.0)[0]) - fold);
    };
    return away(x) < away(y);
  });
  for (const double below : {1e-4, beside}) {
    test::HardCase row(fmt::format("{:.0e} below a fold in T", below), "A(T) by quadrature, one of two");
    const auto orbit =
        continuation::orbit_at_period(*system, nearest->loop, isotropy, static_cast<double>(longest) - below, options);
    ASSERT_TRUE(orbit.converged()) << orbit.detail;
    const Real found = std::abs(loop::state_at(orbit.loop, 0.0)[0]);
    const bool inner = found < fold;
    const Real exact = test::reference::zero_between(
        [&](Real reach) { return Oscillator::period(reach) - orbit.loop.period; }, fold, inner ? 0.3L : 1.6L);
    // A double knows T to 4e-16, hence A to 4e-16/|dT/dA|, and the loss 1e-10 of it.
    row.within(static_cast<double>(std::abs(found - exact)), 1e-8);
  }
  for (const double above : {1e-4, beside}) {
    test::HardCase row(fmt::format("{:.0e} above a fold in T", above), "there is no orbit");
    const auto orbit =
        continuation::orbit_at_period(*system, nearest->loop, isotropy, static_cast<double>(longest) + above, options);
    row.is(!orbit.converged() && !orbit.detail.empty(), "none, and why", orbit.converged() ? "an orbit" : "none");
  }
}

/// The archive of one family of the restricted problem.
test::Atlas lagrange_family() {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm,
                scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_earth_moon.yaml",
                            {"starts.fixed_points.grid=[[0.488], [0.866]]", "starts.fixed_points.names={}",
                             "starts.fixed_points.letters={}", "starts.sweep.period=[20, 22]", "survey.depth=0"}),
                "lagrange");
  EXPECT_EQ(summary.failures, 0U);
  return test::Atlas(summary.atlas);
}

// Where dE/ds = 0 along a family of a conservative system, an index is 2: (DP - 1) dx/ds + dP/dE dE/ds = 0.
TEST(Folds, InTheEnergy) {
  test::HardCase row("L4's long family, fold in E", "an index is 2 where dE/ds = 0");
  const test::Atlas atlas = lagrange_family();
  int seen = 0;
  double worst = 0.0;
  double period = 0.0;
  for (std::size_t n = 0; n < atlas.crossings().rows(); ++n) {
    if (atlas.crossings().texts("kind")[n] != "fold-energy") continue;
    ++seen;
    worst = test::worse(worst, std::abs(atlas.crossings().reals("test_value")[n] - 2.0));
    period = atlas.crossings().reals("period")[n];
  }
  ASSERT_EQ(seen, 1);
  row.within(worst, 1e-8);
  // Beside it T changes with s and E does not to first order: k - 2 changes its sign.
  const auto system = systems::make_system("pcr3bp");
  const std::vector<double>& periods = atlas.orbits().reals("period");
  std::size_t near = 0;
  for (std::size_t n = 0; n < periods.size(); ++n)
    if (std::abs(periods[n] - period) < std::abs(periods[near] - period)) near = n;
  const loop::Loop start = archive::loop_of(atlas, near, {});
  const auto deviation = [&](double at, double& error) {
    const auto orbit = continuation::orbit_at_period(*system, start, {}, at, {});
    EXPECT_TRUE(orbit.converged()) << orbit.detail;
    const spectrum::Stability stability = spectrum::floquet(*system, orbit.loop, {});
    error = stability.full_error.at(0);
    return stability.full.at(0).real() - 2.0;
  };
  double error = 0.0;
  const double before = deviation(period - 1e-3, error);
  const double after = deviation(period + 1e-3, error);
  test::HardCase far("L4's long family, fold in E, T -+ 1e-3", "k passes 2 between");
  far.is(before * after < 0.0, "signs differ", fmt::format("{:.1e}, {:.1e}", before, after));
  const double slope = (after - before) / 2e-3;
  test::HardCase row_beside("L4's long family, fold in E, T -+ 1e-8", "k - 2 as its slope over T -+ 1e-3 says");
  double off = 0.0;
  for (const double side : {-beside, beside})
    off = test::worse(off, std::abs(deviation(period + side, error) - slope * side));
  row_beside.within(off, 1e-7);
}

Eigen::MatrixXd diagonal(std::initializer_list<double> entries) {
  const std::vector<double> values(entries);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())).asDiagonal();
}

// Two pairs turn by 2 pi I and 2 pi 0.2 on the circle of action I, energies of one sign: they meet at I = 0.2 without
// leaving the unit circle. With energies of opposite signs and a coupling c the indices of H = I + x' A x/2,
// A = (I, I, -0.3, -0.3) on the diagonals and c between the two, leave it where |I - 0.3| < c.
TEST(Collisions, OfTwoPairs) {
  const double c = 0.01;
  Eigen::Matrix4d constant = diagonal({0.0, 0.0, -0.3, -0.3});
  constant(0, 2) = constant(2, 0) = c;
  constant(1, 3) = constant(3, 1) = -c;
  const test::PlaneFamily system({constant, diagonal({1, 1, 0, 0}), {}, {}});
  // x_1' = I J x_1 + c J K x_2: with z_1 = q_1 + i p_1 and conj(z_2) the rates of turning are the roots w of
  // (w - I)(w - 0.3) + c^2 = 0, complex for |I - 0.3| < 2 c.
  const auto found_at = [&](double action) {
    const loop::Loop circle = system.circle(action);
    return spectrum::floquet(system, circle, {});
  };
  for (const double edge : {0.3 - 2.0 * c, 0.3 + 2.0 * c})
    for (const double side : {-beside, beside}) {
      const double action = edge + side;
      const double discriminant = 0.25 * (action - 0.3) * (action - 0.3) - c * c;
      test::HardCase row(fmt::format("Krein collision at I = {:.2f}, I {} 1e-8", edge, side > 0.0 ? "+" : "-"),
                         "indices in closed form");
      const spectrum::Stability stability = found_at(action);
      std::vector<std::complex<double>> exact;
      const std::complex<double> root = std::sqrt(std::complex<double>(discriminant));
      for (const double sign : {1.0, -1.0})
        exact.push_back(2.0 * std::cos(2.0 * std::numbers::pi * (0.5 * (action + 0.3) + sign * root)));
      const auto off = [&](std::size_t n, std::size_t m) { return std::abs(stability.full.at(n) - exact.at(m)); };
      row.within(std::min(std::max(off(0, 0), off(1, 1)), std::max(off(0, 1), off(1, 0))), 1e-9);
      const bifurcation::Reading reading =
          bifurcation::evaluate({bifurcation::TestFunction::Kind::krein, {}}, system.structure(), stability);
      const int wanted = discriminant < 0.0 ? -1 : 1;
      test::HardCase(fmt::format("Krein collision at I = {:.2f}, I {} 1e-8", edge, side > 0.0 ? "+" : "-"),
                     "its sign, or none within its error")
          .is(reading.sign() == wanted || reading.sign() == 0, fmt::format("{} or 0", wanted),
              fmt::format("{}", reading.sign()));
    }
}

// A form that turns with the circle, e (q (q_1^2 - p_1^2) + p 2 q_1 p_1)/2, opens a tongue about I = 1/2: with
// w = q_1 + i p_1 = v exp(-i t/2), v' = -i ((I - 1/2) v + e r conj v), r^2 = 2 I, so that
// k = -2 cos(2 pi sqrt((I - 1/2)^2 - 2 I e^2)), and k = -2 at I = 1/2 + e^2 -+ sqrt(e^2 + e^4).
TEST(Crossings, TwoThatAreNear) {
  for (const double e : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    Eigen::Matrix2d by_q;
    Eigen::Matrix2d by_p;
    by_q << e, 0.0, 0.0, -e;
    by_p << 0.0, e, e, 0.0;
    const test::PlaneFamily system({Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity(), by_q, by_p});
    const auto stability_at = [&](double action) { return spectrum::floquet(system, system.circle(action), {}); };
    std::vector<double> positions;
    for (int n = 0; n <= 13; ++n) positions.push_back(0.36 + 0.3 * n / 13);
    const std::string name = fmt::format("two crossings at q = 2, {:.0e} apart", 2.0 * e);
    test::HardCase row(name, "both are found, where they are in closed form");
    const test::Detection found = test::detect(system.structure(), stability_at,
                                               {{bifurcation::TestFunction::Kind::sector, {2, 1}}}, positions, 1e-12);
    double off = found.events.size() == 2 ? 0.0 : 1.0;
    for (std::size_t n = 0; n < found.events.size() && n < 2; ++n) {
      const double half_width = std::sqrt(e * e + e * e * e * e);
      const double away = found.events[n].position - 0.5 - e * e;
      off = test::worse(off, std::abs(std::abs(away) - half_width));
    }
    row.within(off, 1e-7);
  }
}

// Multipliers -exp(2 pi (s +- i r)), r^2 = (turn - 1/2)^2 - d^2: they pass the unit circle where s does 0.
TEST(Collisions, OfATorus) {
  for (const double s : {-beside, beside}) {
    const std::string name = fmt::format("torus bifurcation, s = {:+.0e}", s);
    const test::PlaneCycle system(s, 0.1, 0.2);
    test::HardCase row(name, "multipliers in closed form");
    const spectrum::Stability stability = spectrum::floquet(system, test::PlaneCycle::cycle(), {});
    const double r = std::sqrt(0.3 * 0.3 - 0.1 * 0.1);
    const std::complex<double> exact = -std::exp(2.0 * std::numbers::pi * std::complex<double>(s, r));
    double off = 1.0;
    for (const std::complex<double>& mu : stability.full)
      off = std::min(off, std::min(std::abs(mu - exact), std::abs(mu - std::conj(exact))));
    row.within(off, 1e-10);
    const bifurcation::Reading reading =
        bifurcation::evaluate({bifurcation::TestFunction::Kind::torus, {}}, system.structure(), stability);
    double largest = 0.0;
    for (const std::complex<double>& mu : stability.full) largest = std::max(largest, std::abs(mu));
    test::HardCase(name, "the modulus of the multipliers, exp(2 pi s)")
        .within(std::abs(largest - std::exp(2.0 * std::numbers::pi * s)), 1e-10);
    test::HardCase(name, "the test function has its sign beyond its error")
        .is(reading.sign() != 0, "a sign", fmt::format("{:+.1e}", reading.value));
  }
}

}  // namespace
}  // namespace crossings_test
