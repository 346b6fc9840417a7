#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "support/oscillator_chain.hpp"

namespace orbweaver::test {

/// The slowest oscillation of a chain, all particles to one side, as the start of a branch of symmetric brake orbits.
inline continuation::Start slowest_oscillation(const OscillatorChain& chain, double coupling = 0.1) {
  const int n = chain.dimension() / 2;
  const double half = std::sin(std::numbers::pi / (2 * n + 2));
  const double frequency = std::sqrt(1.0 + 4.0 * coupling * half * half);
  continuation::Start start;
  start.base = loop::constant_loop(std::vector<double>(static_cast<std::size_t>(2 * n), 0.0),
                                   2.0 * std::numbers::pi / frequency, 8);
  loop::Loop oscillation = start.base;
  for (int i = 0; i < n; ++i) {
    const double amplitude = std::sin((i + 1) * std::numbers::pi / (n + 1));
    oscillation.modes[static_cast<std::size_t>(2 * n + i)] = amplitude;               // cos s
    oscillation.modes[static_cast<std::size_t>(5 * n + i)] = -frequency * amplitude;  // sin s
  }
  start.direction.modes = oscillation.modes;
  const systems::Description& description = chain.description();
  start.isotropy = {{"S", false, description.equivariances[0].matrix, 1, 2},
                    {"R", true, description.reversors[0].matrix, 0, 1}};
  return start;
}

}  // namespace orbweaver::test
