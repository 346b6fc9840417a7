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

/// Watches which other base families begin on a branch: at orbits that the scene gives and the branch passes on its
/// way, and small ones that it comes to where its orbits shrink to a point.
class GivenOrbitWatch {
 public:
  GivenOrbitWatch() = default;
  /// `options`: of the branches.
  GivenOrbitWatch(std::shared_ptr<const systems::System> system, GivenOrbits given, continuation::Options options);

  /// Appends to `passed` the given orbits that lie between two neighbours of a branch (bifurcation::same_family): of
  /// families that come after its own, each once. Only branches that base families consist of pass any.
  void watch(const Lineage& own, const loop::Isotropy& isotropy, const continuation::Orbit& from,
             const continuation::Orbit& to, std::vector<PassedStart>& passed) const;
  /// The same of a family of small orbits, at the last orbit of a branch that has shrunk to a point. Appends none where
  /// the orbit is not told to be of one of them: near no direction, or of a family that comes before its own.
  void arrive(const Lineage& own, const loop::Loop& last, std::vector<PassedStart>& passed) const;

 private:
  void add(PassedStart start, const loop::Loop& there, std::vector<PassedStart>& passed) const;
  [[nodiscard]] bool lies_between(const continuation::Orbit& from, const continuation::Orbit& to,
                                  const loop::Isotropy& isotropy, const continuation::Orbit& orbit, int halvings) const;

  std::shared_ptr<const systems::System> _system;
  continuation::Options _options;
  std::vector<GivenOrbit> _given;  // in the order of their families
  std::vector<SmallFamily> _small;
  std::vector<continuation::Orbit> _orbits;  // theirs
};

}  // namespace orbweaver::survey
