#pragma once

#include <limits>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/queue/task.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

/// Follow a crossing in two parameters.
struct LocusWork {
  static constexpr const char* payload_name = "locus work";
  std::string crossing;  ///< its key
  int depth = 0;         ///< of its family
  int entry = 0;         ///< of the scene's loci
  archive::CrossingKind kind = archive::CrossingKind::branch_point;
  bifurcation::Event event{};
  int fundamental_order = 1;
  loop::Isotropy isotropy;
  loop::Loop orbit;       ///< at the crossing
  loop::Tangent tangent;  ///< of the family there

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, crossing, depth, entry, kind, event, fundamental_order, isotropy, orbit, tangent);
  }
};

/// One point of a locus, in the survey's scales.
struct LocusPointRecord {
  int step = 0;  ///< 0 at the crossing
  double arclength = 0.0;
  double period = 0.0;
  double energy = 0.0;
  double parameter = std::numeric_limits<double>::quiet_NaN();
  double second = 0.0;  ///< in the parameter's unit
  std::vector<double> state;
  bool is_return = false;
  std::string note;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, step, arclength, period, energy, parameter, second, state, is_return, note);
  }
};

struct LocusOutcome {
  static constexpr const char* payload_name = "locus outcome";
  std::string crossing;
  int entry = 0;
  std::string second_name;  ///< of the second parameter
  archive::CrossingKind kind = archive::CrossingKind::branch_point;
  bifurcation::Event event{};
  int fundamental_order = 1;
  std::vector<LocusPointRecord> points;  ///< by step
  int limited_by = 0;                    ///< Limit: with wider ones it goes further

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, crossing, entry, second_name, kind, event, fundamental_order, points, limited_by);
    if constexpr (Archive::is_loading::value) check_limits(limited_by);
  }
};

[[nodiscard]] queue::Task task_of(const LocusWork& work);

[[nodiscard]] std::string pack(const LocusWork& work);
[[nodiscard]] std::string pack(const LocusOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] LocusWork unpack_locus_work(const std::string& bytes);
[[nodiscard]] LocusOutcome unpack_locus_outcome(const std::string& bytes);

}  // namespace orbweaver::survey
