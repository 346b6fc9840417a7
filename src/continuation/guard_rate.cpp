#include "guard_rate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "least_guard.hpp"

namespace orbweaver::continuation {

namespace {

/// By Kepler's third law the time of a passage at the distance g goes like g^(3/2).
constexpr double passage_power = 1.5;

}  // namespace

loop::Rate guard_rate(const systems::System& system, double period, double base) {
  return [&system, period, base](const loop::Samples& samples) {
    const auto nodes = static_cast<std::size_t>(samples.nodes);
    std::vector<double> rate(nodes, base * 2.0 * std::numbers::pi / period);
    for (std::size_t k = 0; k < system.structure().guards.size(); ++k) {
      const std::vector<double> g = guard_at(system, static_cast<int>(k), samples);
      const auto at = static_cast<std::size_t>(std::min_element(g.begin(), g.end()) - g.begin());
      const double before = g[(at + nodes - 1) % nodes];
      const double after = g[(at + 1) % nodes];
      const double step = period * samples.weights[at];  // between nodes there, in time
      // g^2 = least^2 + curvature t^2/2 is zero at |t| = least sqrt(2/curvature).
      const double curvature = (before * before - 2.0 * g[at] * g[at] + after * after) / (step * step);
      if (!(curvature > 0.0)) continue;
      const double fastest = std::sqrt(0.5 * curvature) / g[at];
      for (std::size_t j = 0; j < nodes; ++j) rate[j] += fastest * std::pow(g[at] / g[j], passage_power);
    }
    return rate;
  };
}

}  // namespace orbweaver::continuation
