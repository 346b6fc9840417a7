#include <cstdio>
#include <vector>

#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

/// The field of the harmonic oscillator at q = 1, p = 2, by the installed libraries: exit status 0 when it is (2, -9).
int main() {
  const auto system = orbweaver::systems::make_system("harmonic_oscillator", {{"omega", 3.0}});
  const std::vector<double> state{1.0, 2.0};
  std::vector<double> field(2);
  system->field(1, state.data(), field.data());
  std::printf("field %g %g\n", field[0], field[1]);
  return field[0] == 2.0 && field[1] == -9.0 ? 0 : 1;
}
