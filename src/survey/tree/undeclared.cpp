#include "orbweaver/survey/tree/undeclared.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/undeclared_symmetries.hpp"
#include "orbweaver/systems/undeclared_turns.hpp"

namespace orbweaver::survey {

Undeclared undeclared(const systems::System& system, const std::vector<std::vector<double>>& equilibria,
                      const std::vector<std::vector<double>>& states) {
  std::vector<std::vector<double>> centres = equilibria;
  if (centres.empty()) {
    centres.emplace_back(static_cast<std::size_t>(system.dimension()), 0.0);
    centres.insert(centres.end(), states.begin(), states.end());
  }
  return {systems::undeclared_symmetries(system, centres), systems::undeclared_translations(system),
          systems::undeclared_turns(system, centres), systems::may_be_symplectic(system, equilibria)};
}

int undeclared_directions(const systems::System& system, std::span<const double> state, double period,
                          double tolerance) {
  const std::vector<double> z(state.begin(), state.end());
  const auto d = static_cast<Eigen::Index>(z.size());
  const std::vector<double> transition = certificate::transitions(system, {z}, period, tolerance).front();
  // What dz and dT a closed trajectory allows: (M - 1) dz + f dT = 0.
  Eigen::MatrixXd equations(d, d + 1);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index l = 0; l < d; ++l)
      equations(i, l) = transition[static_cast<std::size_t>(i * d + l)] - (i == l ? 1.0 : 0.0);
  std::vector<double> field(z.size());
  system.field(1, z.data(), field.data());
  equations.col(d) = Eigen::Map<const Eigen::VectorXd>(field.data(), d);
  // Rounding and the integrator leave `tolerance` of what is zero: half of the digits stand for it.
  const Eigen::VectorXd values = equations.jacobiSvd().singularValues();
  const double zero = std::sqrt(tolerance) * std::max(1.0, values(0));
  const auto allowed = 1 + d - std::count_if(values.begin(), values.end(), [&](double s) { return s > zero; });
  const auto declared = 1 + static_cast<Eigen::Index>(system.structure().conserved.size());
  return static_cast<int>(std::max<Eigen::Index>(0, allowed - declared));
}

}  // namespace orbweaver::survey
