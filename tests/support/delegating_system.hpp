#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// Another system in all that a test does not override.
class DelegatingSystem : public systems::System {
 public:
  explicit DelegatingSystem(std::shared_ptr<const systems::System> system) : _system(std::move(system)) {}

  [[nodiscard]] const systems::ModelInfo& info() const override { return _system->info(); }
  [[nodiscard]] const systems::Structure& structure() const override { return _system->structure(); }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _system->parameters(); }
  void field(std::size_t nodes, const double* z, double* f) const override { _system->field(nodes, z, f); }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    _system->field_jacobian(nodes, z, f, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* out) const override {
    _system->second_derivatives(nodes, z, weights, out);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> z) const override { return _system->conserved(k, z); }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    _system->conserved_gradient(k, z, gradient);
  }
  [[nodiscard]] double action_density(std::span<const double> z) const override { return _system->action_density(z); }
  [[nodiscard]] double guard(int k, std::span<const double> z) const override { return _system->guard(k, z); }

 protected:
  [[nodiscard]] const systems::System& whole() const { return *_system; }

 private:
  std::shared_ptr<const systems::System> _system;
};

}  // namespace orbweaver::test
