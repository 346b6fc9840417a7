#pragma once

#include <limits>
#include <string>
#include <vector>

#include "lineage.hpp"
#include "locate_work.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/ending.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/systems/structure.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

/// Follow one family from its start to its end.
struct BranchWork {
  static constexpr const char* payload_name = "branch work";
  std::string key;
  std::string name;  ///< for progress; final names are given at the end
  Lineage lineage;
  loop::Loop base;          ///< the equilibrium, the crossing's orbit as many times around as it takes, or an orbit
  loop::Tangent direction;  ///< in its modes, to this branch's side
  loop::Isotropy isotropy;
  double amplitude = 0.0;      ///< |dz(s = 0)| of the first orbit; 0: the scene's
  bool base_is_orbit = false;  ///< `base` is the family's first orbit, `direction` one of its scalars

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, name, lineage, base, direction, isotropy, amplitude, base_is_orbit);
  }
};

/// The crossing beneath the end of a branch that goes around its orbit more often than the scene's subharmonics have
/// other families looked at.
struct CrossingBeneath {
  LocateOutcome crossing;  ///< but its key, its lineage and its arclength: the family that it lies on is not known
  loop::Loop orbit;        ///< there, once around

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, crossing, orbit);
  }
};

/// A branch has come to an orbit with more symmetry than its own: a crossing of another family, or of its own.
struct ArrivalRecord {
  double period = 0.0;                     ///< where it meets, by interpolation, or as the crossing there was located
  double level = 0.0;                      ///< continuation::level_of
  loop::Loop near;                         ///< an orbit of the branch shortly before
  loop::Loop nearest{};                    ///< another, as near as one was found; without modes where none was
  bool is_short = false;                   ///< that is not so near that its multipliers show the meeting
  int multiplicity = 1;                    ///< times that it goes around the orbit it meets, where that is all it gains
  std::vector<CrossingBeneath> beneath{};  ///< one, where the crossing that is met was located
  double ahead = std::numeric_limits<double>::infinity();  ///< rms distance from `near` to the orbit met, if known

  static constexpr int wire_version = 4;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, level, near, nearest, is_short, multiplicity, beneath, ahead);
  }
};

/// A base family that comes after its own begins on a branch: at an orbit that the scene gives, or at its end.
struct PassedStart {
  std::string family;  ///< that of GivenOrbit or SmallFamily, and what else it says
  std::string name;
  std::string told;
  double period = 0.0;  ///< in the units of the scene
  double level = 0.0;   ///< continuation::level_of, in them

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family, name, told, period, level);
  }
};

struct BranchOutcome {
  static constexpr const char* payload_name = "branch outcome";
  std::string key;
  int orbits = 0;
  double before_first = 0.0;  ///< arclength from the crossing to the first orbit
  /// Ranges and last values in the units of the scene.
  double period_from = 0.0;
  double period_to = 0.0;
  double level_from = 0.0;
  double level_to = 0.0;
  double last_period = 0.0;
  double last_level = 0.0;
  int last_cutoff = 0;
  continuation::Ending end;
  std::vector<ArrivalRecord> arrival;  ///< one or none
  int equilibrium = -1;                ///< at which it ended, among the survey's; -1: at none of them
  std::vector<std::string> remarks;
  std::vector<std::string> unlocated;  ///< what was passed, as its multiplier's turns tell, and not found
  double tolerance_met = 0.0;  ///< the largest of the orbits', where rounding keeps one above the tolerance; else 0
  double moved_out = 0.0;      ///< of the first orbit, as continuation::Orbit
  int limited_by = 0;          ///< Limit: with wider ones the branch would have gone on
  /// The state (queue::Task) from which it would, without children, or where that is stored; empty: from its start.
  std::string before_limit;
  std::vector<PassedStart> passed{};

  static constexpr int wire_version = 7;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, orbits, before_first, period_from, period_to, level_from, level_to,
                            last_period, last_level, last_cutoff, end, arrival, equilibrium, remarks, unlocated,
                            tolerance_met, moved_out, limited_by, before_limit, passed);
    if constexpr (Archive::is_loading::value) check_limits(limited_by);
  }
};

[[nodiscard]] queue::Task task_of(const BranchWork& work);

[[nodiscard]] std::string pack(const BranchWork& work);
[[nodiscard]] std::string pack(const BranchOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] BranchWork unpack_branch_work(const std::string& bytes);
[[nodiscard]] BranchOutcome unpack_branch_outcome(const std::string& bytes);

/// The start that a branch's work describes.
[[nodiscard]] continuation::Start start_of(const BranchWork& work, const systems::Structure& system);

}  // namespace orbweaver::survey
