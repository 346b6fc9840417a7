#pragma once

#include <memory>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// A scene and its system told in the survey's scales (docs/mathematics.md, "Scales"): what all tasks work with. Where
/// these are 1, as they were.
class ScaledScene {
 public:
  /// `system` is the scene's system (systems::make_system). Throws InputError for one with more than one conserved
  /// quantity, and what starts::natural_scales does.
  ScaledScene(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system);

  [[nodiscard]] const scene::Scene& scene() const { return _scene; }
  [[nodiscard]] const std::shared_ptr<const systems::System>& system() const { return _system; }
  /// Throws InputError unless these scales are the ones: those of a checkpoint, whose tasks are told in them.
  void expect(const systems::Scales& scales) const;

 private:
  std::shared_ptr<const systems::System> _system;
  scene::Scene _scene;
};

}  // namespace orbweaver::survey
