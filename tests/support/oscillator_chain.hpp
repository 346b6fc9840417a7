#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "support/stated_system.hpp"

namespace orbweaver::test {

/// A chain of N particles on cubic springs, fixed at both ends:
///
///   H = sum_i p_i^2 / 2 + sum_i (q_i^2 / 2 + k q_i^4 / 4) + sum_i (c d_i^2 / 2 + k d_i^4 / 4),   d_i = q_(i+1) - q_i,
///
/// i = 0 .. N with q_0 = q_(N+1) = 0 in the last sum; c the coupling, k the cubic one.
/// State q_1 .. q_N, p_1 .. p_N: dimension 2 N.
/// Small oscillations have the frequencies sqrt(1 + 4 c sin(k pi / (2 N + 2))^2), k = 1 .. N.
class OscillatorChain : public StatedSystem {
 public:
  explicit OscillatorChain(int particles, double coupling = 0.1, double cubic = 1.0)
      : StatedSystem(describe(particles), "oscillator_chain"),
        _n(static_cast<std::size_t>(particles)),
        _coupling(coupling),
        _cubic(cubic) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t i = 0; i < _n; ++i)
      for (std::size_t j = 0; j < nodes; ++j) {
        const double q = z[i * nodes + j];
        const double left = q - (i > 0 ? z[(i - 1) * nodes + j] : 0.0);
        const double right = (i + 1 < _n ? z[(i + 1) * nodes + j] : 0.0) - q;
        f[i * nodes + j] = z[(_n + i) * nodes + j];
        f[(_n + i) * nodes + j] = -q - _cubic * q * q * q + force(right) - force(left);
      }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    const std::size_t d = 2 * _n;
    for (std::size_t e = 0; e < d * d * nodes; ++e) jacobian[e] = 0.0;
    for (std::size_t i = 0; i < _n; ++i)
      for (std::size_t j = 0; j < nodes; ++j) {
        const auto entry = [&](std::size_t row, std::size_t column) -> double& {
          return jacobian[(row * d + column) * nodes + j];
        };
        const double q = z[i * nodes + j];
        const double left = q - (i > 0 ? z[(i - 1) * nodes + j] : 0.0);
        const double right = (i + 1 < _n ? z[(i + 1) * nodes + j] : 0.0) - q;
        entry(i, _n + i) = 1.0;
        entry(_n + i, i) = -1.0 - 3.0 * _cubic * q * q - stiffness(right) - stiffness(left);
        if (i > 0) entry(_n + i, i - 1) = stiffness(left);
        if (i + 1 < _n) entry(_n + i, i + 1) = stiffness(right);
      }
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    const std::size_t d = 2 * _n;
    for (std::size_t e = 0; e < d * d * nodes; ++e) contracted[e] = 0.0;
    for (std::size_t i = 0; i <= _n; ++i)  // the spring between particles i - 1 and i, and the ground of particle i
      for (std::size_t j = 0; j < nodes; ++j) {
        const auto entry = [&](std::size_t row, std::size_t column) -> double& {
          return contracted[(row * d + column) * nodes + j];
        };
        const auto at = [&](std::size_t k) { return z[k * nodes + j]; };
        const auto weight = [&](std::size_t k) { return weights[(_n + k) * nodes + j]; };
        const bool has_left = i > 0;
        const bool has_right = i < _n;
        if (has_right) entry(i, i) += -6.0 * _cubic * at(i) * weight(i);
        const double stretch = (has_right ? at(i) : 0.0) - (has_left ? at(i - 1) : 0.0);
        // Force on the left particle is force(stretch), on the right one its opposite.
        const double bend = 6.0 * _cubic * stretch * ((has_left ? weight(i - 1) : 0.0) - (has_right ? weight(i) : 0.0));
        if (has_left) entry(i - 1, i - 1) += bend;
        if (has_right) entry(i, i) += bend;
        if (has_left && has_right) {
          entry(i - 1, i) -= bend;
          entry(i, i - 1) -= bend;
        }
      }
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    double sum = 0.0;
    for (std::size_t i = 0; i <= _n; ++i) {
      const double q = i < _n ? z[i] : 0.0;
      const double stretch = q - (i > 0 ? z[i - 1] : 0.0);
      sum += 0.5 * _coupling * stretch * stretch + 0.25 * _cubic * stretch * stretch * stretch * stretch;
      sum += 0.5 * q * q + 0.25 * _cubic * q * q * q * q + (i < _n ? 0.5 * z[_n + i] * z[_n + i] : 0.0);
    }
    return sum;
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    std::vector<double> f(2 * _n);
    field(1, z.data(), f.data());
    for (std::size_t i = 0; i < _n; ++i) {
      gradient[i] = -f[_n + i];
      gradient[_n + i] = f[i];
    }
  }
  [[nodiscard]] double action_density(std::span<const double> z) const override {
    double sum = 0.0;
    for (std::size_t i = 0; i < _n; ++i) sum += z[_n + i] * z[_n + i];
    return sum;
  }

 private:
  [[nodiscard]] double force(double stretch) const {
    return _coupling * stretch + _cubic * stretch * stretch * stretch;
  }
  [[nodiscard]] double stiffness(double stretch) const { return _coupling + 3.0 * _cubic * stretch * stretch; }

  static systems::Structure describe(int particles) {
    systems::Structure structure = structure_of(2 * particles, true, true);
    const Eigen::Index d = 2 * particles;
    structure.equivariances = {{"S", -Eigen::MatrixXd::Identity(d, d)}};
    Eigen::MatrixXd reversor = Eigen::MatrixXd::Identity(d, d);
    reversor.bottomRightCorner(particles, particles) *= -1.0;
    structure.reversors = {{"R", reversor}, {"RS", -reversor}};
    return structure;
  }

  std::size_t _n;
  double _coupling;
  double _cubic;
};

}  // namespace orbweaver::test
