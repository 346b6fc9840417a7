#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// A place of a family: an orbit and where it lies along the family.
struct CurvePoint {
  double position = 0.0;  ///< arclength of known orbits, in proportion to the chord between them
  loop::Loop loop;
  loop::Tangent tangent;  ///< unit direction of the family there, towards larger positions; empty where unknown
  double advance = 0.0;   ///< of the position with a unit of `tangent`, of a point of a FamilyCurve
};

class CurveInterval;

/// A stretch of a family between a few known orbits: every orbit between two of them can be had, converged anew.
///
/// The orbit at position a + share (b - a) between the neighbours A and B is the one whose projection on the chord
/// B - A (modes and period, under B's time map) is that share of it: a smooth function of the position that does not
/// depend on what was asked before.
class FamilyCurve {
 public:
  FamilyCurve(std::shared_ptr<const systems::System> system, loop::Isotropy isotropy, const Options& options);
  ~FamilyCurve();
  FamilyCurve(FamilyCurve&&) = delete;
  FamilyCurve& operator=(FamilyCurve&&) = delete;

  /// The next known orbit; positions increase. Only the last `keep` known orbits stay.
  void add(double position, const loop::Loop& loop, std::size_t keep = 5);
  /// The same for one that another curve has known.
  struct Known;
  void add(const Known& known, std::size_t keep = 5);

  /// Known orbits behind a position are no longer known.
  void drop_behind(double position);

  /// Forgets the orbits found in between, which later ones are sought from: as after `add`.
  void forget_found();

  /// Called before every orbit that is sought, some milliseconds apart; may throw.
  void before_each(std::function<void()> call) { _before_each = std::move(call); }

  /// The known orbits, oldest first.
  struct Known {
    double position = 0.0;
    loop::Loop loop;
    double arclength = 0.0;  ///< the position in the units of the scene, where scales are not 1

    static constexpr int wire_version = 2;
    template <class Archive>
    void serialize(Archive& archive, unsigned /*version*/) {
      core::serialize_members(archive, position, loop, arclength);
    }
  };
  [[nodiscard]] const std::vector<Known>& known() const { return _known; }
  [[nodiscard]] const loop::Isotropy& isotropy() const { return _isotropy; }
  [[nodiscard]] const Options& options() const { return _options; }

  /// The archive's arclength at a position within the known orbits, in the units of the scene: linear between them.
  [[nodiscard]] double arclength_at(double position) const;
  /// How long a length of 1 is there in it.
  [[nodiscard]] double arclength_unit_at(double position) const;

  /// The orbit at `position`, which lies between the first and the last known one, with the family's direction there if
  /// that is asked for; none where the corrector fails, which at a known orbit gives that orbit itself. Throws
  /// MisuseError for a position outside.
  [[nodiscard]] std::optional<CurvePoint> at(double position, bool with_tangent = false);

 private:
  /// The index of the known orbit at or behind a position.
  [[nodiscard]] std::size_t interval_of(double position) const;

  std::shared_ptr<const systems::System> _system;
  loop::Isotropy _isotropy;
  Options _options;
  std::function<void()> _before_each;
  std::vector<Known> _known;
  std::map<std::size_t, std::unique_ptr<CurveInterval>> _intervals;  // by the index of their ends
};

}  // namespace orbweaver::continuation
