#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// A small oscillation of the ideal double pendulum by pencil: M w^2 v = G v about an equilibrium, all parameters 1.
struct PendulumMode {
  std::string name;
  std::vector<double> point;  ///< the equilibrium
  double frequency;
  double ratio;  ///< th2 / th1

  [[nodiscard]] double period() const { return 2.0 * std::numbers::pi / frequency; }
};

inline PendulumMode in_phase() {
  return {"In-Phase", {0, 0, 0, 0}, std::sqrt(2.0 - std::numbers::sqrt2), std::numbers::sqrt2};
}
inline PendulumMode out_phase() {
  return {"Out-Phase", {0, 0, 0, 0}, std::sqrt(2.0 + std::numbers::sqrt2), -std::numbers::sqrt2};
}
inline PendulumMode down_up() {
  return {"Down-Up", {0, std::numbers::pi, 0, 0}, std::sqrt(std::numbers::sqrt2), 2.0 - std::numbers::sqrt2};
}
inline PendulumMode up_down() {
  return {"Up-Down", {std::numbers::pi, 0, 0, 0}, std::sqrt(std::numbers::sqrt2), 2.0 + std::numbers::sqrt2};
}

inline std::vector<PendulumMode> pendulum_modes() { return {in_phase(), out_phase(), down_up(), up_down()}; }

/// point + amplitude (1, ratio) cos s with the velocities that belong to it.
inline loop::Loop linear_loop(const PendulumMode& mode, double amplitude, int cutoff) {
  loop::Loop loop = loop::constant_loop(mode.point, mode.period(), cutoff);
  const double shape[2] = {1.0, mode.ratio};
  for (int i = 0; i < 2; ++i) {
    loop.cosine(1, i) = amplitude * shape[i];
    loop.sine(1, 2 + i) = -amplitude * mode.frequency * shape[i];
  }
  return loop;
}

/// S@1/2 R@0: the isotropy of all four families.
inline loop::Isotropy pendulum_isotropy(const systems::System& system) {
  return loop::find_isotropy(system.structure(), linear_loop(in_phase(), 0.1, 1), 1e-9);
}

}  // namespace orbweaver::test
