#pragma once

#include <memory>
#include <string>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// An archive with the system that its scene names, in the survey's scales.
class VerifiedAtlas {
 public:
  /// Throws InputError where the scene or its system is not known here, or does not fit the header.
  explicit VerifiedAtlas(const std::filesystem::path& path);
  /// Of an archive that is open, which is moved from.
  explicit VerifiedAtlas(archive::Archive&& open);

  [[nodiscard]] const archive::Archive& archive() const { return *_archive; }
  [[nodiscard]] const AtlasTree& tree() const { return *_tree; }
  [[nodiscard]] const scene::Scene& scene() const { return _scene; }
  /// In the system's scales. No section, with an empty coordinate, too where the archive is older than its rows.
  [[nodiscard]] scene::Section section() const;
  [[nodiscard]] const std::shared_ptr<const systems::System>& system() const { return _system; }
  [[nodiscard]] const loop::Isotropy& isotropy(std::size_t family) const { return _isotropies[family]; }

  /// Row `orbit` of /orbits, in the survey's scales. Throws InputError where the row holds no loop.
  [[nodiscard]] loop::Loop loop(std::size_t orbit) const;
  /// A loop of the family, begun as its neighbour is, from which it is `way` of the archive's arclength. Reversors fix
  /// where a family's loops begin, to half a period, which the way tells; others were begun where they are nearest to
  /// their neighbour, and are stored in a standard phase.
  [[nodiscard]] loop::Loop begun_as(std::size_t family, const loop::Loop& loop, const loop::Loop& neighbour,
                                    double way) const;
  /// Of its orbits' certificates: what the scene asks for; closures at least, which its modes alone give.
  [[nodiscard]] certificate::Level certificate_level() const;
  /// Whether its rows must have a verdict: a survey that stopped early has none where tasks of their own give them.
  [[nodiscard]] bool claims_certificates() const;
  [[nodiscard]] bool has_reversor(std::size_t family) const;
  /// Whether the scene asked for this orbit: it lies between two others of its branch, apart from the steps.
  [[nodiscard]] bool is_requested(std::size_t orbit) const;

 private:
  std::unique_ptr<archive::Archive> _archive;
  scene::Scene _scene;
  std::shared_ptr<const systems::System> _system;
  std::unique_ptr<AtlasTree> _tree;
  std::vector<loop::Isotropy> _isotropies;
};

/// What row `orbit` says of its orbit, whose loop is `loop`.
[[nodiscard]] certificate::Evidence stored_evidence(const VerifiedAtlas& atlas, std::size_t orbit,
                                                    const loop::Loop& loop);

}  // namespace orbweaver::survey
