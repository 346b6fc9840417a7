#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"

namespace orbweaver::test {

/// A rotator, state q, p: with I = (q^2 + p^2)/2 the circles turn at w(I) = 1 + I/10 - 5 I^2/2, fastest at I = 0.02.
class Rotator final : public test::DelegatingSystem {
 public:
  Rotator() : DelegatingSystem(systems::make_system("harmonic_oscillator")) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      const double w = rate(size_of(z[j], z[nodes + j]));
      f[j] = w * z[nodes + j];
      f[nodes + j] = -w * z[j];
    }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      const double q = z[j];
      const double p = z[nodes + j];
      const double size = size_of(q, p);
      const double slope = 0.1 - 5.0 * size;
      jacobian[j] = slope * q * p;
      jacobian[nodes + j] = rate(size) + slope * p * p;
      jacobian[2 * nodes + j] = -rate(size) - slope * q * q;
      jacobian[3 * nodes + j] = -slope * q * p;
    }
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    const double size = size_of(z[0], z[1]);
    return size + 0.05 * size * size - 2.5 / 3.0 * size * size * size;
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    const double w = rate(size_of(z[0], z[1]));
    gradient[0] = w * z[0];
    gradient[1] = w * z[1];
  }
  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return rate(size_of(z[0], z[1])) * z[1] * z[1];
  }

 private:
  static double size_of(double q, double p) { return 0.5 * (q * q + p * p); }
  static double rate(double size) { return 1.0 + 0.1 * size - 2.5 * size * size; }
};

}  // namespace orbweaver::test
