#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <vector>

/// Computations that share nothing with Orbweaver but the laws of motion, in long double (64 bits): an integrator by
/// extrapolation, and the fields written anew, from their Lagrangians or in other coordinates.
namespace orbweaver::test::reference {

using Real = long double;
inline constexpr Real pi = 3.141592653589793238462643383279502884L;

template <std::size_t D>
using Point = std::array<Real, D>;

template <std::size_t D>
[[nodiscard]] Point<D> point_of(std::span<const double> z) {
  Point<D> out{};
  std::copy_n(z.begin(), D, out.begin());
  return out;
}

template <std::size_t D>
[[nodiscard]] Real distance(const Point<D>& a, const Point<D>& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < D; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Gragg's modified midpoint rule over `step`, in `parts`.
template <class Field, std::size_t D>
[[nodiscard]] Point<D> midpoint_rule(const Field& field, const Point<D>& z, Real step, int parts) {
  const Real h = step / parts;
  Point<D> before = z;
  Point<D> here = z;
  const Point<D> first = field(z);
  for (std::size_t i = 0; i < D; ++i) here[i] += h * first[i];
  for (int n = 1; n < parts; ++n) {
    const Point<D> f = field(here);
    for (std::size_t i = 0; i < D; ++i) before[i] += 2 * h * f[i];
    std::swap(before, here);
  }
  const Point<D> last = field(here);
  for (std::size_t i = 0; i < D; ++i) here[i] = (before[i] + here[i] + h * last[i]) / 2;
  return here;
}

/// The state after `time` (negative: before): the midpoint rule extrapolated in the square of its step (Bulirsch and
/// Stoer 1966, doi:10.1007/BF02165234), each step until two columns agree to `tolerance` times 1 + |z|. `seen` is
/// called after each step with the time and the state; it may end the integration by returning false.
template <class Field, std::size_t D, class Seen>
[[nodiscard]] Point<D> flow(const Field& field, Point<D> z, Real time, Real tolerance, const Seen& seen) {
  constexpr std::size_t columns = 12;
  Real done = 0;
  Real step = time / 50;
  for (int n = 0; std::abs(time - done) > 0; ++n) {
    if (n > 2000000) throw std::runtime_error("reference: too many steps");
    if (std::abs(step) > std::abs(time - done)) step = time - done;
    std::vector<Point<D>> table;
    std::size_t k = 0;
    bool met = false;
    for (; k < columns && !met; ++k) {
      Point<D> value = midpoint_rule(field, z, step, static_cast<int>(2 * (k + 1)));
      for (std::size_t j = 1; j <= k; ++j) {
        const Real ratio = static_cast<Real>(k + 1) / static_cast<Real>(k + 1 - j);
        const Point<D> coarser = table[j - 1];
        table[j - 1] = value;
        for (std::size_t i = 0; i < D; ++i) value[i] += (value[i] - coarser[i]) / (ratio * ratio - 1);
      }
      if (k > 2) {
        Real size = 0;
        for (const Real& x : value) size = std::max(size, std::abs(x));
        met = distance(value, table[k - 1]) <= tolerance * (1 + size);
      }
      table.push_back(value);
    }
    if (!met) {
      step /= 2;
      continue;
    }
    z = table.back();
    done = std::abs(step) >= std::abs(time - done) ? time : done + step;
    if (!seen(done, z)) return z;
    if (k < 9) step *= 1.5L;
  }
  return z;
}
template <class Field, std::size_t D>
[[nodiscard]] Point<D> flow(const Field& field, const Point<D>& z, Real time, Real tolerance = 1e-17L) {
  return flow(field, z, time, tolerance, [](Real, const Point<D>&) { return true; });
}

/// The double pendulum from its kinetic and potential energy,
///   T = m1 l1^2 w1^2/2 + m2 (l1^2 w1^2 + l2^2 w2^2 + 2 l1 l2 w1 w2 cos(th1 - th2))/2,
///   V = -(m1 + m2) g l1 cos th1 - m2 g l2 cos th2:
/// the two equations d/dt dT/dw = dT/dth - dV/dth are solved by Cramer's rule at each state.
struct DoublePendulum {
  Real m1 = 1;
  Real m2 = 1;
  Real l1 = 1;
  Real l2 = 1;
  Real g = 1;

  [[nodiscard]] Point<4> operator()(const Point<4>& z) const {
    const Real c = std::cos(z[0] - z[1]);
    const Real s = std::sin(z[0] - z[1]);
    const Real a = (m1 + m2) * l1 * l1;
    const Real b = m2 * l1 * l2 * c;
    const Real d = m2 * l2 * l2;
    const Real e = -m2 * l1 * l2 * s * z[3] * z[3] - (m1 + m2) * g * l1 * std::sin(z[0]);
    const Real f = m2 * l1 * l2 * s * z[2] * z[2] - m2 * g * l2 * std::sin(z[1]);
    const Real determinant = a * d - b * b;
    return {z[2], z[3], (e * d - b * f) / determinant, (a * f - b * e) / determinant};
  }
};

/// A mass on a spring in a vertical plane, in polar coordinates r, angle from the downward vertical, and their rates:
///   r'' = r angle'^2 + g cos(angle) - (k/m)(r - l),  angle'' = -(2 r' angle' + g sin(angle))/r.
struct SwingingSpring {
  Real mass = 1;
  Real stiffness = 3;
  Real length = 1;
  Real gravity = 1;

  [[nodiscard]] Point<4> operator()(const Point<4>& z) const {
    return {z[2], z[3], z[0] * z[3] * z[3] + gravity * std::cos(z[1]) - stiffness / mass * (z[0] - length),
            -(2 * z[2] * z[3] + gravity * std::sin(z[1])) / z[0]};
  }
  [[nodiscard]] static Point<4> from_plane(const Point<4>& z) {
    const Real r = std::hypot(z[0], z[1]);
    return {r, std::atan2(z[0], -z[1]), (z[0] * z[2] + z[1] * z[3]) / r, (z[0] * z[3] - z[1] * z[2]) / (r * r)};
  }
};

/// Quarter period of the pendulum q'' = -sin q that swings to the angle pi - `gap`, by the arithmetic-geometric mean.
[[nodiscard]] inline Real pendulum_quarter(Real gap) {
  Real a = 1;
  Real b = std::sin(gap / 2);
  for (int n = 0; n < 20; ++n) {
    const Real mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return pi / (2 * a);
}

/// The zero of a function between two places where its signs differ, by bisection.
[[nodiscard]] inline Real zero_between(const std::function<Real(Real)>& f, Real from, Real to) {
  const bool rises = f(to) > 0;
  for (int n = 0; n < 400; ++n) {
    const Real middle = (from + to) / 2;
    if (middle == from || middle == to) break;
    ((f(middle) > 0) == rises ? to : from) = middle;
  }
  return (from + to) / 2;
}

/// How far from upright the pendulum's orbit of this period comes to rest.
[[nodiscard]] inline Real pendulum_gap(Real period) {
  return zero_between([&](Real gap) { return 4 * pendulum_quarter(gap) - period; }, 1e-300L, pi);
}

}  // namespace orbweaver::test::reference
