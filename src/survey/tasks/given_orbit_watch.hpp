#pragma once

#include <memory>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload/branch_work.hpp"
#include "tasks/payload/given_orbits.hpp"

namespace orbweaver::survey {

/// Watches which of the orbits that the scene gives a branch passes on its way: they lie on the branch's family.
class GivenOrbitWatch {
 public:
  GivenOrbitWatch() = default;
  /// `options`: of the branches.
  GivenOrbitWatch(std::shared_ptr<const systems::System> system, GivenOrbits given, continuation::Options options);

  /// Appends to `passed` the given orbits that lie between two neighbours of a branch (bifurcation::same_family): of
  /// families that come after its own, each once. Only branches that base families consist of pass any.
  void watch(const Lineage& own, const loop::Isotropy& isotropy, const continuation::Orbit& from,
             const continuation::Orbit& to, std::vector<PassedStart>& passed) const;

 private:
  [[nodiscard]] bool lies_between(const continuation::Orbit& from, const continuation::Orbit& to,
                                  const loop::Isotropy& isotropy, const continuation::Orbit& orbit, int halvings) const;

  std::shared_ptr<const systems::System> _system;
  continuation::Options _options;
  std::vector<GivenOrbit> _given;            // in the order of their families
  std::vector<continuation::Orbit> _orbits;  // theirs
};

}  // namespace orbweaver::survey
