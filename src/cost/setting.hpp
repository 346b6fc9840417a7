#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/cost/ladders.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "true_orbit.hpp"

namespace orbweaver::cost {

/// An orbit that solvers are measured on.
struct Probe {
  std::string name;  ///< "middle", "end"
  continuation::Orbit orbit;
  loop::Tangent tangent;  ///< the family's direction there
  loop::Loop neighbour;   ///< the orbit of the branch before it
};

/// The first event of a family: what a location gets along.
struct FoundEvent {
  bifurcation::Event event;
  double from = 0.0;
  double to = 0.0;
  std::vector<continuation::FamilyCurve::Known> known;
};

/// What is measured on: a scene, one of its families, two orbits of that. The family: the first one of the scene's
/// first equilibrium that has any (or the one named), as far as the scene follows it. The orbits: those in the middle
/// of its arclength and at nine tenths of it, or the last before these that can be refined.
class Setting {
 public:
  /// Throws as cost::measure.
  Setting(const core::Communicator& comm, const scene::Scene& scene, const Options& options);

  [[nodiscard]] const core::Communicator& comm() const { return _comm; }
  [[nodiscard]] bool quick() const { return _quick; }
  /// Seconds to spend on repetitions of one measurement.
  [[nodiscard]] double budget() const { return _quick ? 0.02 : 0.2; }
  /// Seconds after which one measurement is given up; the family itself ends after three times that.
  [[nodiscard]] double patience() const { return _quick ? 2.5 : 20.0; }
  [[nodiscard]] const scene::Scene& asked() const { return _asked; }           ///< in the units of the user
  [[nodiscard]] const scene::Scene& scene() const { return _scaled.scene(); }  ///< in the scales
  [[nodiscard]] const std::shared_ptr<const systems::System>& plain() const { return _plain; }
  [[nodiscard]] const std::shared_ptr<const systems::System>& system() const { return _scaled.system(); }
  [[nodiscard]] const std::string& family() const { return _family; }
  [[nodiscard]] const continuation::Start& start() const { return _start; }
  [[nodiscard]] const loop::Isotropy& isotropy() const { return _start.isotropy; }
  [[nodiscard]] const continuation::Options& branch_options() const { return _options; }
  [[nodiscard]] const std::vector<continuation::Orbit>& orbits() const { return _orbits; }
  [[nodiscard]] const std::string& ending() const { return _ending; }
  [[nodiscard]] const std::vector<Probe>& probes() const { return _probes; }
  /// That of a probe. Throws NumericalError where there is none.
  [[nodiscard]] const TrueOrbit& truth_of(const Probe& probe) const;
  /// That of one orbit of several along a family.
  [[nodiscard]] TrueOrbit truth_beside(const loop::Loop& orbit, const loop::Loop& neighbour) const;
  /// The first crossing of a multiplier along the family, by branches with these options; none if there is none.
  [[nodiscard]] std::optional<FoundEvent> first_event(const continuation::Options& options) const;

 private:
  void choose_family(const std::string& wanted);
  void trace();
  void place_probes();

  const core::Communicator& _comm;
  bool _quick;
  scene::Scene _asked;
  std::shared_ptr<const systems::System> _plain;
  survey::ScaledScene _scaled;
  std::string _family;
  continuation::Start _start;
  continuation::Options _options;
  std::vector<continuation::Orbit> _orbits;
  std::string _ending;
  std::vector<Probe> _probes;
  std::vector<std::unique_ptr<TrueOrbit>> _truths;  // one a probe; null where no orbit can be refined
};

}  // namespace orbweaver::cost
