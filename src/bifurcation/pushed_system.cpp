#include "pushed_system.hpp"

#include <algorithm>
#include <utility>

#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

PushedSystem::PushedSystem(const systems::System& base, std::vector<double> centre, double strength)
    : _base(base), _centre(std::move(centre)), _parameters(base.parameters()) {
  core::require(_centre.size() == static_cast<std::size_t>(base.dimension()), "a push needs a centre of the dimension");
  core::require(base.structure().conservative(), "a push needs a conserved quantity to keep");
  _parameters[push] = strength;
}

void PushedSystem::add_push(std::size_t nodes, const double* z, double strength, double* f) const {
  const auto d = static_cast<std::size_t>(dimension());
  std::vector<double> gradients(d * nodes);
  _base.conserved_gradients(0, nodes, z, gradients.data());
  std::vector<double> w(d);
  for (std::size_t j = 0; j < nodes; ++j) {
    double along = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < d; ++i) {
      const double g = gradients[i * nodes + j];
      w[i] = structure().is_angle(i) ? 0.0 : z[i * nodes + j] - _centre[i];
      along += g * w[i];
      square += g * g;
    }
    const double share = square > 0.0 ? along / square : 0.0;
    for (std::size_t i = 0; i < d; ++i) f[i * nodes + j] += strength * (w[i] - share * gradients[i * nodes + j]);
  }
}

void PushedSystem::field(std::size_t nodes, const double* z, double* f) const {
  _base.field(nodes, z, f);
  add_push(nodes, z, _parameters.at(push), f);
}

void PushedSystem::field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const {
  _base.field_jacobian(nodes, z, f, jacobian);
  add_push(nodes, z, _parameters.at(push), f);
}

void PushedSystem::parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                                         double* derivatives) const {
  core::require(name == push, "a pushed system is differentiated by its push only");
  std::fill_n(derivatives, static_cast<std::size_t>(dimension()) * nodes, 0.0);
  add_push(nodes, z, 1.0, derivatives);
}

std::shared_ptr<const systems::System> PushedSystem::with_parameters(
    const std::map<std::string, double>& values) const {
  core::require(values.size() == 1 && values.contains(push), "of a pushed system only the push moves");
  return std::make_shared<PushedSystem>(_base, _centre, values.at(push));
}

}  // namespace orbweaver::bifurcation
