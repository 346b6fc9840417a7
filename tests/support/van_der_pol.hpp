#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::test {

/// x' = y, y' = mu (1 - x^2) y - x: one limit cycle for each mu > 0, and nothing that is conserved.
class VanDerPol final : public StatedSystem {
 public:
  explicit VanDerPol(double mu, systems::FamilyScalars kind = {})
      : StatedSystem(structure_of(2), "van_der_pol"), _mu(mu), _parameters{{"mu", mu}}, _kind(std::move(kind)) {}

  [[nodiscard]] const systems::FamilyScalars& family_scalars() const override { return _kind; }

  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      const double x = z[j];
      const double y = z[nodes + j];
      f[j] = y;
      f[nodes + j] = _mu * (1.0 - x * x) * y - x;
    }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      const double x = z[j];
      const double y = z[nodes + j];
      jacobian[j] = 0.0;
      jacobian[nodes + j] = 1.0;
      jacobian[2 * nodes + j] = -2.0 * _mu * x * y - 1.0;
      jacobian[3 * nodes + j] = _mu * (1.0 - x * x);
    }
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      const double weight = weights[nodes + j];
      contracted[j] = -2.0 * _mu * z[nodes + j] * weight;
      contracted[nodes + j] = contracted[2 * nodes + j] = -2.0 * _mu * z[j] * weight;
      contracted[3 * nodes + j] = 0.0;
    }
  }
  void parameter_derivatives(const std::string&, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      derivatives[j] = 0.0;
      derivatives[nodes + j] = (1.0 - z[j] * z[j]) * z[nodes + j];
    }
  }
  [[nodiscard]] std::shared_ptr<const systems::System> with_parameters(
      const std::map<std::string, double>& values) const override {
    return std::make_shared<const VanDerPol>(values.at("mu"));
  }

 private:
  double _mu;
  std::map<std::string, double> _parameters;
  systems::FamilyScalars _kind;
};

}  // namespace orbweaver::test
