#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"

namespace orbweaver::test {

/// The shipped scene with a coarse sweep over the periods that its four families start at, and these overrides.
inline scene::Scene quick_scene(const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"starts.sweep.step=0.05", "starts.sweep.period=[2,9]", "survey.depth=0"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml", overrides);
}

}  // namespace orbweaver::test
