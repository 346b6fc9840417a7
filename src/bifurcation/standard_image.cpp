#include "standard_image.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"

namespace orbweaver::bifurcation {

bool starts_further(const loop::Loop& a, const loop::Loop& b, double tolerance) {
  const std::vector<double> here = loop::state_at(a, 0.0);
  const std::vector<double> there = loop::state_at(b, 0.0);
  for (std::size_t i = 0; i < here.size(); ++i)
    if (std::abs(here[i] - there[i]) > tolerance) return here[i] > there[i];
  return false;
}

loop::Loop standard_image(const systems::Structure& system, const KernelActions& group, const loop::Loop& orbit,
                          double tolerance) {
  std::optional<loop::Loop> first;
  for (const Action& action : group.actions()) {
    if (action.element.shift_numerator != 0) continue;
    loop::Loop image = loop::at_first_reversor(system, loop::transformed(orbit, action.element), tolerance);
    image = loop::in_standard_phase(system, image, loop::find_isotropy(system, image, tolerance, group.denominator()));
    if (!first || starts_further(image, *first, tolerance)) first = std::move(image);
  }
  return first.value();
}

}  // namespace orbweaver::bifurcation
