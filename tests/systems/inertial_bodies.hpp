#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace orbweaver::test {

using Vector2 = Eigen::Vector2d;

/// Three point masses with G = 1, their centre of mass at rest at the origin.
struct Inertial {
  std::array<double, 3> masses{};
  std::array<Vector2, 3> x;
  std::array<Vector2, 3> v;

  /// Newton's law.
  [[nodiscard]] std::array<Vector2, 3> accelerations() const {
    std::array<Vector2, 3> a;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i].setZero();
      for (std::size_t l = 0; l < 3; ++l)
        if (l != i) a[i] += masses[l] * (x[l] - x[i]) / std::pow((x[l] - x[i]).norm(), 3);
    }
    return a;
  }
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += 0.5 * masses[i] * v[i].squaredNorm();
      for (std::size_t l = 0; l < i; ++l) sum -= masses[i] * masses[l] / (x[i] - x[l]).norm();
    }
    return sum;
  }
  [[nodiscard]] double angular_momentum() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) sum += masses[i] * (x[i].x() * v[i].y() - x[i].y() * v[i].x());
    return sum;
  }
  [[nodiscard]] Vector2 momentum() const { return masses[0] * v[0] + masses[1] * v[1] + masses[2] * v[2]; }
};

/// The bodies of a state r, x, y, pr, px, py of `three_bodies`, body 2 at this angle from body 1.
inline Inertial inertial(const std::map<std::string, double>& parameters, const std::vector<double>& z, double angle) {
  Inertial bodies;
  auto& m = bodies.masses;
  m = {parameters.at("m1"), parameters.at("m2"), parameters.at("m3")};
  const double pair = m[0] + m[1];
  const double all = pair + m[2];
  const Vector2 e(std::cos(angle), std::sin(angle));
  const Vector2 n(-e.y(), e.x());
  const Vector2 way = z[0] * e;
  const Vector2 third = z[1] * e + z[2] * n;
  // Velocities of the two vectors: that of `third` from its momentum, the turning of `way` from what is left of L.
  const Vector2 third_speed = all / (m[2] * pair) * (z[4] * e + z[5] * n);
  const double own = parameters.at("L") - (z[1] * z[5] - z[2] * z[4]);
  const Vector2 speed = pair / (m[0] * m[1]) * (z[3] * e + own / z[0] * n);
  const auto place = [&](const Vector2& inner, const Vector2& outer) {
    const Vector2 centre = -m[2] / all * outer;  // of bodies 1 and 2
    return std::array<Vector2, 3>{centre - m[1] / pair * inner, centre + m[0] / pair * inner, centre + outer};
  };
  bodies.x = place(way, third);
  bodies.v = place(speed, third_speed);
  return bodies;
}

}  // namespace orbweaver::test
