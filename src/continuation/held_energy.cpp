#include "held_energy.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/continuation/orbit.hpp"

namespace orbweaver::continuation {

double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n) {
  constexpr double step = 1e-5;  // relative: rounding 1e-11, truncation 1e-10; a Newton step needs two digits
  const double by = step * std::max(1.0, std::abs(loop.parameters[n]));
  loop::Loop above = loop;
  loop::Loop below = loop;
  above.parameters[n] += by;
  below.parameters[n] -= by;
  return (energy_of(system, above) - energy_of(system, below)) / (2.0 * by);
}

}  // namespace orbweaver::continuation
