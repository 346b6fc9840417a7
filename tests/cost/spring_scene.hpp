#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"

namespace orbweaver::test {

/// The swinging spring: its family Bounce is the linear oscillation y = y_0 + a cos(sqrt(3) t), x = 0, whatever a.
inline scene::Scene spring_scene(const std::vector<std::string>& overrides = {}) {
  return scene::parse(R"(
system: {name: swinging_spring, parameters: {mass: 1, stiffness: 3, length: 1, gravity: 1}}
starts:
  fixed_points:
    grid: [[0], [-1.333]]
    names: {[0, -1.3333333333]: [Cup, Cap, Bounce]}
  sweep: {period: [3, 8]}
continuation: {start: 0.01}
limits: {energy: [-.inf, -0.3], steps: 60}
)",
                      "spring.yaml", overrides);
}

}  // namespace orbweaver::test
