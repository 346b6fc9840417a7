#pragma once

#include <cmath>
#include <limits>

#include "support/stated_system.hpp"

namespace orbweaver::test {

/// q' = p, p' = -q - damping p, reversible for damping 0; the field is NaN where q > wall.
class Oscillator final : public StatedSystem {
 public:
  explicit Oscillator(double damping, double wall = std::numeric_limits<double>::infinity())
      : StatedSystem(described(), "test_oscillator"), _damping(damping), _wall(wall) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      f[j] = z[nodes + j];
      f[nodes + j] = z[j] > _wall ? std::numeric_limits<double>::quiet_NaN() : -z[j] - _damping * z[nodes + j];
    }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    const double entries[4] = {0.0, 1.0, -1.0, -_damping};
    for (std::size_t e = 0; e < 4; ++e)
      for (std::size_t j = 0; j < nodes; ++j) jacobian[e * nodes + j] = entries[e];
  }
  void second_derivatives(std::size_t nodes, const double*, const double*, double* contracted) const override {
    for (std::size_t n = 0; n < 4 * nodes; ++n) contracted[n] = 0.0;
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[0] * z[0] + z[1] * z[1]);
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    gradient[0] = z[0];
    gradient[1] = z[1];
  }
  [[nodiscard]] double action_density(std::span<const double> z) const override { return z[1] * z[1]; }

 private:
  double _damping;
  double _wall;
  static systems::Structure described() {
    systems::Structure structure = structure_of(2, true, true);
    structure.equivariances = {{"S", -Eigen::Matrix2d::Identity()}};
    structure.reversors = {{"R", Eigen::Matrix2d(Eigen::Vector2d(1, -1).asDiagonal())}};
    return structure;
  }
};

}  // namespace orbweaver::test
