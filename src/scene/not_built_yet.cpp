#include "orbweaver/scene/scene.hpp"

#include <fmt/format.h>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::scene {

std::vector<std::string> not_built_yet(const Scene& scene) {
  std::vector<std::string> sentences;
  const auto say = [&](bool asked, const std::string& sentence) {
    if (asked) sentences.push_back(sentence);
  };
  const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  say(!system->structure().conservative() || !scene.system.effects.empty(),
      "system: continuation of systems without a conserved energy, or with effects, is not built yet.");
  say(!scene.section.coordinate.empty(),
      fmt::format("section: crossings of the Poincare section {} = {:g} are not computed yet.",
                  scene.section.coordinate, scene.section.value));
  return sentences;
}

}  // namespace orbweaver::scene
