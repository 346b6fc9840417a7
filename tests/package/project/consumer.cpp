#include <cstdio>
#include <vector>

#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace systems = orbweaver::systems;

/// q' = p, p' = -k q, recorded from C++.
struct Spring {
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return {"spring", "A spring", "a mass on a spring", {"q", "p"}, {"", ""}, {{"k", 1.0, 0.0, 100.0}}, {}};
  }
  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.dissipative = true;
    return structure;
  }
  template <class P>
  struct With {
    P k;
    explicit With(const systems::BoundTo<P>& bound) : k(bound["k"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = -z[0] * k;
    }
  };
};

/// The fields of the program's oscillator and of a spring of this program at q = 1, p = 2, by the installed libraries:
/// exit status 0 when both are (2, -9).
int main() {
  systems::add_recorded<Spring>();
  bool is_right = true;
  for (const auto& system :
       {systems::make_system("harmonic_oscillator", {{"omega", 3.0}}), systems::make_system("spring", {{"k", 9.0}})}) {
    const std::vector<double> state{1.0, 2.0};
    std::vector<double> field(2);
    system->field(1, state.data(), field.data());
    std::printf("field %g %g\n", field[0], field[1]);
    is_right = is_right && field[0] == 2.0 && field[1] == -9.0;
  }
  return is_right ? 0 : 1;
}
