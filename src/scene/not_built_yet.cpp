#include "orbweaver/scene/scene.hpp"

#include <fmt/format.h>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::scene {

std::vector<std::string> not_built_yet(const Scene& scene) {
  std::vector<std::string> sentences;
  const auto say = [&](bool asked, const std::string& sentence) {
    if (asked) sentences.push_back(sentence);
  };
  const systems::Description& system = systems::describe_system(scene.system.name);
  say(!system.conservative || !scene.system.effects.empty(),
      "system: continuation of systems without a conserved energy, or with effects, is not built yet.");
  say(scene.survey.depth > 0,
      fmt::format("survey.depth = {}: crossings are not located and branches are not followed yet; only base families "
                  "(depth 0) are computed.",
                  scene.survey.depth));
  say(scene.survey.subharmonics > 1,
      fmt::format("survey.subharmonics = {}: branches that close after several periods are not looked for yet.",
                  scene.survey.subharmonics));
  say(scene.survey.team_size > 1,
      fmt::format(
          "survey.team_size = {}: teams of ranks that share a task are not built yet; every task runs on one rank.",
          scene.survey.team_size));
  say(!scene.events.periods.empty(), "events.periods: orbits at requested periods are not located yet.");
  say(!scene.events.energies.empty(), "events.energies: orbits at requested energies are not located yet.");
  say(!scene.section.coordinate.empty(),
      fmt::format("section: crossings of the Poincare section {} = {:g} are not computed yet.",
                  scene.section.coordinate, scene.section.value));
  return sentences;
}

}  // namespace orbweaver::scene
