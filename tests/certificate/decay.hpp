#pragma once

#include <cmath>
#include <limits>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::certificate {

/// dz/dt = -rate z, which conserves nothing; the field is NaN below `wall`. Exact: z(t) = z(0) exp(-rate t).
class Decay final : public systems::System {
 public:
  explicit Decay(double rate, double wall = -1.0) : _rate(rate), _wall(wall) {
    _description.name = "decay";
    _description.state_names = {"z"};
  }

  [[nodiscard]] const systems::Description& description() const override { return _description; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
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
  [[nodiscard]] double energy(std::span<const double>) const override { return nan; }
  void energy_gradient(std::span<const double>, std::span<double> gradient) const override { gradient[0] = nan; }
  [[nodiscard]] double action_density(std::span<const double>) const override { return nan; }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  double _rate;
  double _wall;
  systems::Description _description;
  std::map<std::string, double> _parameters;
};

}  // namespace orbweaver::certificate
