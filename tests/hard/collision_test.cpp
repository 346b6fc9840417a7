// The restricted three-body problem close to a collision, against Levi-Civita's coordinates, in which a collision is a
// regular point (Szebehely 1967, Theory of Orbits, ch. 3).
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "continuation/families.hpp"
#include "hard/hard_case.hpp"
#include "hard/reference.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/starts/sweep.hpp"

namespace collision_test {
namespace {

using namespace orbweaver;
using test::reference::Point;
using test::reference::Real;
using Complex = std::complex<Real>;

/// About the smaller body, x + i y = 1 - mu + u^2 and dt = 4 |u|^2 dtau: with G = (x^2 + y^2)/2 + (1 - mu)/r1 + E,
///   u'' + 8 i |u|^2 u' = grad_u (4 |u|^2 G).
/// State u, u', t.
struct LeviCivita {
  Real mu;
  Real energy;

  [[nodiscard]] Point<5> operator()(const Point<5>& z) const {
    const Real square = z[0] * z[0] + z[1] * z[1];
    const Real x = 1 - mu + z[0] * z[0] - z[1] * z[1];
    const Real y = 2 * z[0] * z[1];
    const Real r1 = std::hypot(x + mu, y);
    const Real g = (x * x + y * y) / 2 + (1 - mu) / r1 + energy;
    const Real gx = x - (1 - mu) * (x + mu) / (r1 * r1 * r1);
    const Real gy = y - (1 - mu) * y / (r1 * r1 * r1);
    return {z[2], z[3], 8 * z[0] * g + 8 * square * (gx * z[0] + gy * z[1]) + 8 * square * z[3],
            8 * z[1] * g + 8 * square * (-gx * z[1] + gy * z[0]) - 8 * square * z[2], 4 * square};
  }

  /// The orbit through a state of the plane.
  LeviCivita(Real mass, const Point<4>& z) : mu(mass) {
    const Real r1 = std::hypot(z[0] + mu, z[1]);
    const Real r2 = std::hypot(z[0] + mu - 1, z[1]);
    energy = (z[2] * z[2] + z[3] * z[3] - z[0] * z[0] - z[1] * z[1]) / 2 - (1 - mu) / r1 - mu / r2;
  }
  [[nodiscard]] Point<5> regular(const Point<4>& z) const {
    const Complex u = std::sqrt(Complex(z[0] + mu - 1, z[1]));
    const Complex rate = Real(2) * Complex(z[2], z[3]) * std::conj(u);
    return {u.real(), u.imag(), rate.real(), rate.imag(), 0};
  }
  [[nodiscard]] Point<4> plane(const Point<5>& w) const {
    const Complex u(w[0], w[1]);
    const Complex at = u * u;
    const Complex velocity = Complex(w[2], w[3]) / (Real(2) * std::conj(u));
    return {at.real() + 1 - mu, at.imag(), velocity.real(), velocity.imag()};
  }
  /// After this time.
  [[nodiscard]] Point<4> after(const Point<4>& z, Real time) const {
    Point<5> w = regular(z);
    for (int n = 0; n < 1000 && std::abs(time - w[4]) > 1e-16L; ++n) {
      const Real rate = 4 * (w[0] * w[0] + w[1] * w[1]);
      w = test::reference::flow(*this, w, std::clamp<Real>((time - w[4]) / rate, -0.2L, 0.2L), 1e-16L);
    }
    return plane(w);
  }
};

/// The Lyapunov family of the Earth and Moon's L2, which runs into the Moon, as far as the guard r2 says.
test::Trace second_family(double least_distance) {
  const auto system = systems::make_system("pcr3bp");
  const auto points = starts::find_fixed_points(*system, {{1.156}, {0.0}});
  const starts::SweepResult swept =
      starts::sweep(*system, points.at(0), {.period_from = 3.0, .period_to = 3.6, .step = 0.1});
  const starts::NormalMode& mode = swept.modes.at(0);
  continuation::Options options;
  options.start_amplitude = 0.01;
  if (least_distance > 0.0) options.guard_limits["r2"] = least_distance;
  return test::trace_of(system, {loop::constant_loop(points.at(0), mode.period, 10), mode.direction, mode.isotropy},
                        options);
}

TEST(Collision, WithTheMoon) {
  const double mu = systems::make_system("pcr3bp")->parameters().at("mu");
  for (const double limit : {1e-2, 1e-3, 2e-4}) {
    const std::string name = fmt::format("Earth-Moon L2 family, r2 = {:.0e}", limit);
    test::HardCase row(name, "the limit is reached");
    const test::Trace trace = second_family(limit);
    row.is(trace.ending.reason == continuation::EndReason::guard_limit, "guard limit", trace.ending.text());
    ASSERT_FALSE(trace.orbits.empty());
    const loop::Loop& orbit = trace.last().loop;
    const auto r2 = [&](const Point<4>& z) { return std::hypot(z[0] + Real(mu) - 1, z[1]); };
    // From the end that is far from the Moon to the other, half a period later, where symmetry makes y = vx = 0.
    const double half = 0.5 * orbit.period;
    const auto first = test::reference::point_of<4>(loop::state_at(orbit, 0.0));
    const auto second = test::reference::point_of<4>(loop::state_at(orbit, half));
    const bool begins_far = r2(first) > r2(second);
    const Point<4>& far = begins_far ? first : second;
    const Point<4>& near = begins_far ? second : first;
    const LeviCivita law(mu, far);
    const Point<4> reached = law.after(far, half);
    test::HardCase(name, "r2 at the passage by Levi-Civita's coordinates, relative")
        .within(static_cast<double>(std::abs(r2(reached) / r2(near) - 1)), 1e-6);
    test::HardCase(name, "the limit, relative").within(std::abs(static_cast<double>(r2(near)) / limit - 1.0), 1e-9);
    test::HardCase(name, "vx/vy and y/r2 there")
        .within(static_cast<double>(test::worse(static_cast<double>(std::abs(reached[2] / reached[3])),
                                                static_cast<double>(std::abs(reached[1] / r2(reached))))),
                1e-5);
    // And on to the far end.
    const Point<4> back = law.after(far, orbit.period);
    test::HardCase(name, "closes by Levi-Civita's coordinates")
        .within(static_cast<double>(test::reference::distance(back, far)), 1e-6);
  }
}

TEST(Collision, IsCalledOne) {
  test::HardCase row("Earth-Moon L2 family without a limit", "ends in a collision with the Moon (Henon 1997)");
  const test::Trace trace = second_family(0.0);
  row.is(trace.ending.reason == continuation::EndReason::collision, "collision with the smaller body",
         trace.ending.text());
}

}  // namespace
}  // namespace collision_test
