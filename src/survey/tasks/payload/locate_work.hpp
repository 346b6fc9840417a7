#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lineage.hpp"
#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/queue/task.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

/// Locate an event of a family, and find what leaves there.
struct LocateWork {
  static constexpr const char* payload_name = "locate work";
  std::string key;   ///< of the crossing
  std::string name;  ///< of the branch, for progress
  Lineage lineage;   ///< of the family that it lies on
  loop::Isotropy isotropy;
  std::vector<continuation::FamilyCurve::Known> known;
  double before_first =
      0.0;  ///< arclength from the crossing where the family was born to its first orbit, in the units of the scene
  bifurcation::Event event{};
  double from = 0.0;
  double to = 0.0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, name, lineage, isotropy, known, before_first, event, from, to);
  }
};

/// One direction in which a family leaves a crossing, as rank 0 remembers it to know arrivals again (few harmonics).
struct LeavingRecord {
  std::string key;  ///< of the family
  loop::Isotropy isotropy;
  bool both_sides = false;
  bool hidden = false;  ///< by rounding: nothing is started along it
  loop::Loop base;
  loop::Tangent direction;
  loop::Tangent opposite;  ///< of the other side; empty: -direction

  [[nodiscard]] loop::Tangent way(int side) const { return bifurcation::way_to_side(direction, opposite, side); }

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, isotropy, both_sides, hidden, base, direction, opposite);
  }
};

/// The key of the branch along one side of the direction.
[[nodiscard]] std::string branch_key(const LeavingRecord& leaving, int side);

struct LocateOutcome {
  static constexpr const char* payload_name = "locate outcome";
  std::string key;
  Lineage lineage;
  double arclength = 0.0;  ///< on its branch (signed_arclength), in the units of the scene
  double within = 0.0;     ///< how long the part of the branch is in which it was looked for
  double period = 0.0;
  double energy = 0.0;
  double parameter = std::numeric_limits<double>::quiet_NaN();  ///< that moves
  [[nodiscard]] double level() const { return std::isnan(parameter) ? energy : parameter; }
  std::optional<archive::CrossingKind> kind;  ///< none: nothing crosses there
  int multiplicity = 1;
  int kernel_dimension = 0;
  double residual = 0.0;
  bifurcation::PlaceError place_error;
  double kernel_singular_value = 0.0;
  double next_singular_value = 0.0;
  double test_value = 0.0;
  std::vector<double> state;
  int q = 1;
  int j = 0;
  int fundamental_order = 1;
  std::vector<LeavingRecord> leaving;
  bool undecided = false;  ///< rounding decides in which directions families leave, or in which others
  std::string remark;
  int limited_by = 0;  ///< Limit: with wider ones more would have been looked for

  static constexpr int wire_version = 5;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, lineage, arclength, within, period, energy, parameter, kind,
                            multiplicity, kernel_dimension, residual, place_error, kernel_singular_value,
                            next_singular_value, test_value, state, q, j, fundamental_order, leaving, undecided, remark,
                            limited_by);
    if constexpr (Archive::is_loading::value) check_limits(limited_by);
  }
};

[[nodiscard]] queue::Task task_of(const LocateWork& work);

[[nodiscard]] std::string pack(const LocateWork& work);
[[nodiscard]] std::string pack(const LocateOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] LocateWork unpack_locate_work(const std::string& bytes);
[[nodiscard]] LocateOutcome unpack_locate_outcome(const std::string& bytes);

}  // namespace orbweaver::survey
