#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::bifurcation {

/// f + push w, with w(z) = (z - centre) less its part along the gradient of the first conserved quantity (angles are
/// left out): a conservative system whose volume grows, which has the same conserved quantity. Its periodic orbits with
/// push = 0 are those of f. The Jacobian is that of f: it is meant for small pushes.
class PushedSystem final : public systems::System {
 public:
  static constexpr const char* push = "push";

  /// `base` must outlive it.
  PushedSystem(const systems::System& base, std::vector<double> centre, double strength = 0.0);

  [[nodiscard]] const systems::ModelInfo& info() const override { return _base.info(); }
  [[nodiscard]] const systems::Structure& structure() const override { return _base.structure(); }
  [[nodiscard]] const systems::Scales& scales() const override { return _base.scales(); }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }

  void field(std::size_t nodes, const double* z, double* f) const override;
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override;
  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    _base.second_derivatives(nodes, z, weights, contracted);
  }
  /// By `push` only.
  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override;
  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override;

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override { return _base.conserved(k, z); }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    _base.conserved_gradient(k, z, gradient);
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    _base.conserved_gradients(k, nodes, z, gradients);
  }
  [[nodiscard]] double guard(int k, std::span<const double> z) const override { return _base.guard(k, z); }
  [[nodiscard]] double action_density(std::span<const double> z) const override { return _base.action_density(z); }

 private:
  void add_push(std::size_t nodes, const double* z, double strength, double* f) const;

  const systems::System& _base;
  std::vector<double> _centre;
  std::map<std::string, double> _parameters;
};

}  // namespace orbweaver::bifurcation
