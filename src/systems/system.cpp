#include "orbweaver/systems/system.hpp"

#include <algorithm>

#include "orbweaver/core/error.hpp"

namespace orbweaver::systems {

std::vector<std::string> System::winding_names() const {
  std::vector<std::string> names;
  for (const int i : structure().angles) names.push_back(info().winding_names.at(static_cast<std::size_t>(i)));
  return names;
}

const Scales& System::scales() const {
  static const Scales units;
  return units;
}

const FamilyScalars& System::family_scalars() const {
  static const FamilyScalars only_period;
  return only_period;
}

double System::parameter_scale(const std::string& name) const {
  const std::vector<std::string>& free = family_scalars().free;
  const auto found = std::find(free.begin(), free.end(), name);
  return found == free.end() ? 1.0 : scales().parameter(static_cast<std::size_t>(found - free.begin()));
}

void System::parameter_derivatives(const std::string&, std::size_t, const double*, double*) const {
  throw core::MisuseError("this system does not differentiate by its parameters");
}

std::shared_ptr<const System> System::with_parameters(const std::map<std::string, double>&) const {
  throw core::MisuseError("the parameters of this system do not move");
}

void System::conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const {
  const auto d = static_cast<std::size_t>(dimension());
  std::vector<double> state(d);
  std::vector<double> gradient(d);
  for (std::size_t j = 0; j < nodes; ++j) {
    for (std::size_t i = 0; i < d; ++i) state[i] = z[i * nodes + j];
    conserved_gradient(k, state, gradient);
    for (std::size_t i = 0; i < d; ++i) gradients[i * nodes + j] = gradient[i];
  }
}

double System::guard(int, std::span<const double>) const {
  throw core::MisuseError("this system has no such guard: ask for those that its structure names");
}

}  // namespace orbweaver::systems
