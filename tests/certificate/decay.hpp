#pragma once

#include <cmath>
#include <limits>

#include "support/stated_system.hpp"

namespace orbweaver::certificate {

/// dz/dt = -rate z, which conserves nothing; the field is NaN below `wall`. Exact: z(t) = z(0) exp(-rate t).
class Decay final : public test::StatedSystem {
 public:
  explicit Decay(double rate, double wall = -1.0)
      : StatedSystem(test::structure_of(1), "decay"), _rate(rate), _wall(wall) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) f[j] = z[j] < _wall ? nan : -_rate * z[j];
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) jacobian[j] = -_rate;
  }
  void second_derivatives(std::size_t nodes, const double*, const double*, double* contracted) const override {
    for (std::size_t j = 0; j < nodes; ++j) contracted[j] = 0.0;
  }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  double _rate;
  double _wall;
};

}  // namespace orbweaver::certificate
