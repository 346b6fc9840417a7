#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::test {

/// Lorenz's equations with sigma = 10 and beta = 8/3, written out: x' = sigma (y - x), y' = x (rho - z) - y,
/// z' = x y - beta z; (x, y) -> (-x, -y) maps orbits to orbits.
class LorenzEquations final : public StatedSystem {
 public:
  explicit LorenzEquations(double rho)
      : StatedSystem(structure_with_symmetry(), "lorenz"), _rho(rho), _parameters{{"rho", rho}} {}

  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  [[nodiscard]] const systems::FamilyScalars& family_scalars() const override {
    static const systems::FamilyScalars kind{{"rho"}, systems::FamilyScalars::Hold::nothing};
    return kind;
  }

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      const double x = z[j];
      const double y = z[nodes + j];
      const double w = z[2 * nodes + j];
      f[j] = sigma * (y - x);
      f[nodes + j] = x * (_rho - w) - y;
      f[2 * nodes + j] = x * y - beta * w;
    }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      const double x = z[j];
      const double y = z[nodes + j];
      const double w = z[2 * nodes + j];
      const double entries[9] = {-sigma, sigma, 0.0, _rho - w, -1.0, -x, y, x, -beta};
      for (std::size_t e = 0; e < 9; ++e) jacobian[e * nodes + j] = entries[e];
    }
  }
  void parameter_derivatives(const std::string&, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      derivatives[j] = derivatives[2 * nodes + j] = 0.0;
      derivatives[nodes + j] = z[j];
    }
  }
  [[nodiscard]] std::shared_ptr<const systems::System> with_parameters(
      const std::map<std::string, double>& values) const override {
    return std::make_shared<const LorenzEquations>(values.at("rho"));
  }

 private:
  static constexpr double sigma = 10.0;
  static constexpr double beta = 8.0 / 3.0;

  static systems::Structure structure_with_symmetry() {
    systems::Structure structure = structure_of(3);
    const Eigen::Matrix3d s = Eigen::Vector3d(-1, -1, 1).asDiagonal();
    structure.equivariances = {{"S", s}};
    return structure;
  }

  double _rho;
  std::map<std::string, double> _parameters;
};

}  // namespace orbweaver::test
