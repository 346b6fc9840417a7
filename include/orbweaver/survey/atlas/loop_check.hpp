#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// What the loop of an orbit says of its place on a family.
struct LoopAnswer {
  bool same = false;
  double distance = 0.0;  ///< from the family, as bifurcation::Comparison measures it
  double allowed = 0.0;   ///< continuation::same_within
  std::string detail;
  bool decided = true;  ///< as in bifurcation::Comparison
};

/// An orbit of one of two atlases beside a family of the other.
struct OrbitBeside {
  const AtlasTree& own;
  const TreeFamily& family;
  std::size_t orbit;
  const AtlasTree& other;
  const TreeFamily& beside;
  std::size_t segment;  ///< between its orbits segment and segment + 1
};

/// Holds loops of one atlas against families of the other.
class LoopCheck {
 public:
  /// `system`, in whose scales loops are compared: null where its formulas are missing; then loops are compared by
  /// their modes alone, and only those of orbits that both atlases have at one place.
  explicit LoopCheck(std::shared_ptr<const systems::System> system) : _system(std::move(system)) {}

  [[nodiscard]] bool can_compare() const { return _system != nullptr; }
  [[nodiscard]] const systems::Structure* structure() const { return _system ? &_system->structure() : nullptr; }

  [[nodiscard]] LoopAnswer ask(const OrbitBeside& x) const;

  /// Of an orbit that is the other family's (`ask`): whether the orbits from it to one of the neighbours are one curve.
  /// Planes across a chord meet all families there, and beside a narrow gap the other one may be the nearer; beside a
  /// crossing it may have symmetries that the neighbours lack. False too where that cannot be told.
  /// Requires can_compare(), as do the next two.
  [[nodiscard]] bool is_on_curve(const OrbitBeside& x) const;

  /// Whether the orbit at a crossing of the atlas, gone around as what is born there, lies on `beside` between its
  /// orbits `segment` and the next. Not decided where it cannot be converged between its family's orbits, and these
  /// are not far from the segment.
  [[nodiscard]] LoopAnswer ask_crossing(const AtlasTree& tree, std::size_t crossing, const TreeFamily& beside,
                                        std::size_t segment) const;

  /// Where an orbit, in the system's scales, lies on `beside` between its orbits `segment` and the next: its arclength
  /// there. None where it does not.
  [[nodiscard]] std::optional<double> arclength_of(const loop::Loop& loop, const AtlasTree& tree,
                                                   const TreeFamily& beside, std::size_t segment) const;

  /// `count` orbits of `family`, evenly among those that have a place on `other` (`fits`: of all its orbits); without
  /// formulas those of them that are compared.
  struct Sample {
    std::size_t orbit = 0;
    LoopAnswer answer;
  };
  [[nodiscard]] std::vector<Sample> sample(const AtlasTree& own, const TreeFamily& family, const AtlasTree& other,
                                           const TreeFamily& beside, const std::vector<CurveFit>& fits,
                                           int count) const;

  /// Whether two families that share their invariants are the same: true as soon as one of a few orbits says so, and
  /// where that cannot be found out.
  [[nodiscard]] bool are_same(const AtlasTree& a, const TreeFamily& family_a, const AtlasTree& b,
                              const TreeFamily& family_b) const;

 private:
  struct Between {
    LoopAnswer answer;
    double position = 0.0;  ///< on the chord: 0 at the first orbit, 1 at the second
  };
  /// Whether `orbit`, once around, lies on `beside` between its orbits `segment` and the next.
  [[nodiscard]] Between between_orbits(const continuation::Orbit& orbit, const AtlasTree& tree,
                                       const TreeFamily& beside, std::size_t segment) const;
  /// Whether the orbit at a crossing, which is not known, lies not between the orbits `segment` and the next of
  /// `beside`: those stored on either side of the crossing lie further away than it may be from them.
  [[nodiscard]] bool passes_by(const AtlasTree& tree, std::size_t crossing, const TreeFamily& beside,
                               std::size_t segment) const;
  /// The orbit at a crossing, from those beside it, the one where the family is born among them.
  [[nodiscard]] std::optional<loop::Loop> orbit_at(const AtlasTree& tree, std::size_t crossing) const;

  std::shared_ptr<const systems::System> _system;
};

}  // namespace orbweaver::survey
