#include "held_energy.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/loop/curve/system_at.hpp"

namespace orbweaver::continuation {

double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n,
                           std::span<const double> states, std::span<const double> weights) {
  constexpr double step = 1e-5;  // relative: rounding 1e-11, truncation 1e-10; a Newton step needs two digits
  const double by = step * std::max(1.0, std::abs(loop.parameters[n]));
  const auto energy = [&](double moved) {
    loop::Loop beside = loop;
    beside.parameters[n] += moved;
    const auto there = loop::system_at(system, beside);
    const auto d = static_cast<std::size_t>(loop.dimension);
    double sum = 0.0;
    for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[j] * there->conserved(0, states.subspan(j * d, d));
    return sum;
  };
  return (energy(by) - energy(-by)) / (2.0 * by);
}

double energy_by_parameter(const systems::System& system, const loop::Loop& loop, std::size_t n) {
  constexpr double whole = 1.0;
  return energy_by_parameter(system, loop, n, loop::state_at(loop, 0.0), {&whole, 1});
}

}  // namespace orbweaver::continuation
