// Directions at equilibria where several oscillations share a period.
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>

#include "bifurcation/crossings.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/point_systems.hpp"
#include "support/even_well.hpp"

namespace orbweaver::bifurcation::equilibrium_test {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

Directions all_at_origin(const systems::System& system) {
  const std::vector<double> origin(4, 0.0);
  const starts::SweepResult swept = starts::sweep(system, origin, {.period_from = 6.0, .period_to = 6.5, .step = 0.05});
  EXPECT_EQ(swept.degenerate.size(), 1u);
  const starts::DegenerateMode& mode = swept.degenerate.at(0);
  return equilibrium_directions(system, origin, mode, 10);
}

std::vector<Direction> directions_at_origin(const systems::System& system) { return all_at_origin(system).found; }

std::vector<std::string> isotropies(const std::vector<Direction>& directions) {
  std::vector<std::string> out;
  for (const Direction& d : directions) out.push_back(loop::to_text(d.isotropy));
  return out;
}

/// T(E) of Henon-Heiles along x = 0: y'' = y^2 - y between the two lower roots of E = y^2 / 2 - y^3 / 3.
double straight_line_period(double energy) {
  const auto root = [&](double low, double high) {
    const auto f = [&](double y) { return energy - y * y / 2 + y * y * y / 3; };
    const auto [a, b] = boost::math::tools::bisect(f, low, high, boost::math::tools::eps_tolerance<double>(52));
    return 0.5 * (a + b);
  };
  const double low = root(-1.0, 0.0);
  const double high = root(0.0, 1.0);
  const double third = 1.5 - low - high;  // the sum of the roots of y^3 - 3 y^2 / 2 + 3 E
  const auto density = [&](double angle) {
    const double y = 0.5 * (low + high) + 0.5 * (high - low) * std::sin(angle);
    return 2.0 / std::sqrt(2.0 / 3.0 * (third - y));
  };
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(density, -two_pi / 4, two_pi / 4, 8, 1e-14);
}

/// The energy of even_well averaged over the oscillation Re(A e^{it}), Re(B e^{it}), to fourth order: of the quartic
/// terms, and of how the cubic ones displace it, by a mean force and one of twice the frequency.
double averaged_energy(std::map<std::string, double>& well, std::complex<double> A, std::complex<double> B) {
  const double a = well["a"], b = well["b"];
  const double mean_x = a * (A * std::conj(B)).real();
  const double mean_y = (a * std::norm(A) + 3.0 * b * std::norm(B)) / 2.0;
  const double twice = std::norm(a * A * B) + std::norm((a * A * A + 3.0 * b * B * B) / 2.0);
  const double quartic = 0.375 * (well["c"] * std::norm(A * A) + well["e"] * std::norm(B * B)) +
                         well["d"] * (std::norm(A * B) / 4.0 + (A * A * std::conj(B * B)).real() / 8.0);
  return quartic - (mean_x * mean_x + mean_y * mean_y - twice / 6.0) / 2.0;
}

/// Where on the circle from A = 1 to B = 1 the averaged energy has an extremum, in |A|^2 - |B|^2, `between` being its
/// value half way: one is there if that is in (-1, 1).
double extremum_between(double at_x, double at_y, double between) {
  return (at_x - at_y) / 4.0 / (between - (at_x + at_y) / 2.0);
}

TEST(Equilibrium, AsManyFamiliesLeaveAnEvenWellAsItsAveragedEnergyHasExtrema) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> coefficient(-0.4, 0.4);
  const double half = std::sqrt(0.5);
  std::map<int, int> wells;
  for (int n = 0; n < 80; ++n) {
    std::map<std::string, double> well{{"k1", 1.0}, {"k2", 1.0}};
    for (const char* name : {"a", "b", "c", "d", "e"}) well[name] = coefficient(random);
    const double at_x = averaged_energy(well, 1.0, 0.0);
    const double at_y = averaged_energy(well, 0.0, 1.0);
    int expected = 2;  // along x, nearly, and along y
    bool is_clear = true;
    for (const std::complex<double> phase : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      const double place = std::abs(extremum_between(at_x, at_y, averaged_energy(well, half, half * phase)));
      if (place < 1.0) ++expected;
      is_clear = is_clear && (place < 0.98 || place > 1.02);
    }
    if (!is_clear) continue;
    SCOPED_TRACE(testing::PrintToString(well));
    EXPECT_EQ(directions_at_origin(*test::even_well(well)).size(), static_cast<std::size_t>(expected));
    ++wells[expected];
  }
  EXPECT_GT(wells[2], 0);
  EXPECT_GT(wells[3], 0);
  EXPECT_GT(wells[4], 0);
}

TEST(Equilibrium, ThreeFamiliesUpToSymmetryLeaveHenonHeiles) {
  const auto system = systems::make_system("henon_heiles");
  const std::vector<Direction> found = directions_at_origin(*system);
  ASSERT_EQ(isotropies(found), (std::vector<std::string>{"S@0 R@0", "S@1/2 R@0", "C@1/3 RS@0"}));

  std::vector<continuation::Orbit> ends;
  for (const Direction& direction : found) {
    EXPECT_FALSE(direction.both_sides);
    EXPECT_EQ(direction.amplitude, 0.0);
    continuation::Options options;
    options.energy_to = 0.1;
    const test::Trace trace = test::trace_of(system, {direction.base, direction.tangent, direction.isotropy}, options);
    EXPECT_EQ(trace.ending.reason, continuation::EndReason::energy_limit) << trace.ending.text();
    ends.push_back(trace.last());
    const loop::Loop& loop = ends.back().loop;
    EXPECT_NEAR(ends.back().energy, 0.1, 1e-13);
    const certificate::Certificate certificate = certificate::certify(*system, loop);
    EXPECT_LT(certificate.closure, 1e-10);
    EXPECT_LT(certificate.energy_drift, 1e-12);
    // dW/dE = T: its mean over a step lies between the periods at both ends.
    for (std::size_t n = 1; n < trace.orbits.size(); ++n) {
      const continuation::Orbit& a = trace.orbits[n - 1];
      const continuation::Orbit& b = trace.orbits[n];
      const double mean = (b.action - a.action) / (b.energy - a.energy);
      const double rounding = 1e-14 * b.loop.period / (b.energy - a.energy);
      EXPECT_GT(mean, std::min(a.loop.period, b.loop.period) - rounding);
      EXPECT_LT(mean, std::max(a.loop.period, b.loop.period) + rounding);
    }
    const loop::Isotropy here = loop::find_isotropy(system->structure(), loop, 1e-6, 12);
    EXPECT_EQ(loop::to_text(here), loop::to_text(direction.isotropy));
  }
  EXPECT_NEAR(ends[0].loop.period, straight_line_period(0.1), 1e-11);
  for (std::size_t a = 0; a < ends.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_GT(std::abs(ends[a].loop.period - ends[b].loop.period), 1e-3);
      EXPECT_FALSE(loop::find_map(system->structure(), ends[a].loop, ends[b].loop, 1e-2, 12).has_value());
    }
  EXPECT_LT(std::abs(loop::state_at(ends[0].loop, 1.0)[0]), 1e-12);
  EXPECT_GT(std::abs(loop::state_at(ends[1].loop, 0.0)[0]), 0.1);
}

/// Two oscillators, equal but for the detuning (of the second's stiffness), H = (p^2 + q^2) / 2 + quartic (q1^4 +
/// q2^4) / 4 + coupling q1^2 q2^2 / 2; state q1, q2, p1, p2. Families from the origin: along an axis (2), along a
/// diagonal (2), and loops (2, one up to reversal).
class CoupledOscillators final : public test::PointSystem {
 public:
  CoupledOscillators(systems::Structure structure, double coupling, double quartic = 1.0, double detuning = 0.0)
      : PointSystem(std::move(structure)), _coupling(coupling), _quartic(quartic), _second(1.0 + detuning) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const Eigen::Vector4d g = gradient_at(z);
    return Eigen::Vector4d(g(2), g(3), -g(0), -g(1));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a.topRightCorner<2, 2>().setIdentity();
    const double cross = -2 * _coupling * z(0) * z(1);
    a.bottomLeftCorner<2, 2>() << -1 - 3 * _quartic * z(0) * z(0) - _coupling * z(1) * z(1), cross, cross,
        -_second - 3 * _quartic * z(1) * z(1) - _coupling * z(0) * z(0);
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector4d(z(0) + _quartic * std::pow(z(0), 3) + _coupling * z(0) * z(1) * z(1),
                           _second * z(1) + _quartic * std::pow(z(1), 3) + _coupling * z(1) * z(0) * z(0), z(2), z(3));
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return (z[0] * z[0] + _second * z[1] * z[1] + z[2] * z[2] + z[3] * z[3]) / 2 +
           _quartic * (std::pow(z[0], 4) + std::pow(z[1], 4)) / 4 + _coupling * z[0] * z[0] * z[1] * z[1] / 2;
  }

  enum class Says { all, reversor, nothing };
  [[nodiscard]] static systems::Structure described(Says says) {
    systems::Structure d = test::structure_of(4, true, true);
    const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    if (says != Says::nothing) d.reversors = {{"R", reverse}};
    if (says != Says::all) return d;
    Eigen::Matrix4d swap = Eigen::Matrix4d::Zero();
    swap(0, 1) = swap(1, 0) = swap(2, 3) = swap(3, 2) = 1;
    const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
    d.equivariances = {{"S", mirror}, {"X", swap}};
    d.reversors.push_back({"RS", reverse * mirror});
    return d;
  }

 private:
  double _coupling;
  double _quartic;
  double _second;
};

/// Ratios of the oscillations' complex amplitudes, q2 / q1: 0 or infinity on an axis, +-1 on a diagonal, +-i loops.
std::vector<std::string> kinds(const std::vector<Direction>& directions) {
  std::vector<std::string> out;
  for (const Direction& d : directions) {
    loop::Loop v = d.base;
    v.modes = d.tangent.modes;
    const std::complex<double> first(v.cosine(1, 0), -v.sine(1, 0));
    const std::complex<double> second(v.cosine(1, 1), -v.sine(1, 1));
    if (std::min(std::abs(first), std::abs(second)) < 0.02)
      out.emplace_back(std::abs(first) < std::abs(second) ? "second axis" : "first axis");
    else if (std::abs(second / first - 1.0) < 0.05)
      out.emplace_back("diagonal");
    else if (std::abs(second / first + 1.0) < 0.05)
      out.emplace_back("other diagonal");
    else if (std::abs(std::abs((second / first).imag()) - 1.0) < 0.05)
      out.emplace_back((second / first).imag() > 0 ? "loop" : "other loop");
    else
      out.emplace_back("?");
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Equilibrium, OscillatorsWithTheirSymmetriesDeclared) {
  const CoupledOscillators system(CoupledOscillators::described(CoupledOscillators::Says::all), 0.3);
  const std::vector<Direction> found = directions_at_origin(system);
  EXPECT_EQ(found.size(), 3u);
  const std::vector<std::string> names = kinds(found);
  EXPECT_EQ(std::count(names.begin(), names.end(), "?"), 0);
  for (const Direction& d : found) EXPECT_EQ(d.amplitude, 0.0) << loop::to_text(d.isotropy);
}

TEST(Equilibrium, OscillatorsWithoutDeclaredSymmetriesAreFoundByASearch) {
  const CoupledOscillators reversible(CoupledOscillators::described(CoupledOscillators::Says::reversor), 0.3);
  EXPECT_EQ(kinds(directions_at_origin(reversible)),
            (std::vector<std::string>{"diagonal", "first axis", "other diagonal", "other loop", "second axis"}));
  const CoupledOscillators bare(CoupledOscillators::described(CoupledOscillators::Says::nothing), 0.3);
  EXPECT_EQ(
      kinds(directions_at_origin(bare)),
      (std::vector<std::string>{"diagonal", "first axis", "loop", "other diagonal", "other loop", "second axis"}));
}

// Of amplitude 0.01 orbits do not tell a detuning below its square from none; above, each oscillation is by itself.
TEST(Equilibrium, OscillatorsOfNearlyOnePeriod) {
  for (const double detuning : {1e-9, -1e-6, 1e-6})
    EXPECT_EQ(kinds(directions_at_origin(CoupledOscillators(
                  CoupledOscillators::described(CoupledOscillators::Says::reversor), 0.3, 1.0, detuning))),
              (std::vector<std::string>{"diagonal", "first axis", "other diagonal", "other loop", "second axis"}))
        << detuning;
  const CoupledOscillators apart(CoupledOscillators::described(CoupledOscillators::Says::reversor), 0.3, 1.0, 2e-3);
  const starts::SweepResult swept =
      starts::sweep(apart, std::vector<double>(4, 0.0), {.period_from = 6.0, .period_to = 6.5, .step = 0.05});
  EXPECT_EQ(swept.modes.size(), 2u);
}

// With a coupling of 1 the potential is that of a central force: every direction has its own straight orbit,
// and only the circular ones are isolated.
TEST(Equilibrium, AContinuumOfDirectionsIsLeftOut) {
  const CoupledOscillators bare(CoupledOscillators::described(CoupledOscillators::Says::nothing), 1.0);
  EXPECT_EQ(kinds(directions_at_origin(bare)), (std::vector<std::string>{"loop", "other loop"}));
  // Two uncoupled linear oscillators: nothing is isolated.
  const Directions none = all_at_origin(CoupledOscillators(bare.structure(), 0.0, 0.0));
  EXPECT_TRUE(none.found.empty());
  EXPECT_GT(none.not_isolated, 0);
  EXPECT_FALSE(none.doubt.empty());
}

// A single oscillation has one direction, with or without a reversor.
TEST(Equilibrium, ASingleOscillation) {
  const auto system = systems::make_system("harmonic_oscillator");
  const Eigen::VectorXcd v = Eigen::Vector2cd(std::complex<double>(0, 1), -1.0).normalized();
  const starts::SharedPeriod mode{two_pi, 0.0, {{}}, v, {1}};
  const std::vector<Direction> found = equilibrium_directions(*system, std::vector<double>(2, 0.0), mode, 4).found;
  EXPECT_EQ(isotropies(found), (std::vector<std::string>{"S@1/2 R@0"}));
  const test::Declaring bare(system, {}, {});
  EXPECT_EQ(isotropies(equilibrium_directions(bare, std::vector<double>(2, 0.0), mode, 4).found),
            (std::vector<std::string>{""}));
}

}  // namespace
}  // namespace orbweaver::bifurcation::equilibrium_test
