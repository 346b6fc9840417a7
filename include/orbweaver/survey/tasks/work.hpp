#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/systems/description.hpp"

namespace orbweaver::survey {

/// What a task is to do.
enum class TaskKind { sweep, branch, locate, start };
/// As in queue::Task::kind.
[[nodiscard]] const char* name_of(TaskKind kind);
/// Throws EnvironmentError for a task that is none of ours.
[[nodiscard]] TaskKind kind_of(const queue::Task& task);

/// Limits of the scene that an outcome may rest on, as bits: with a wider one the task is done again.
enum Limit : int { period_limited = 1, energy_limited = 2, step_limited = 4, depth_limited = 8 };

/// A loop as it travels.
struct LoopRecord {
  int dimension = 0;
  int cutoff = 0;
  double period = 0.0;
  std::vector<double> modes;
  std::vector<double> winding;
  std::vector<double> time_map;  ///< as in the archive
};
[[nodiscard]] LoopRecord record_of(const loop::Loop& loop);
[[nodiscard]] loop::Loop loop_of(const LoopRecord& record);

/// Generators of an isotropy as they travel: names that the system declares, and shifts.
struct IsotropyRecord {
  std::vector<std::string> names;
  std::vector<int> reversing;
  std::vector<int> shift_numerators;
  std::vector<int> shift_denominators;
};
[[nodiscard]] IsotropyRecord record_of(const loop::Isotropy& isotropy);
/// With the matrices that `system` declares. Throws EnvironmentError for a name that it does not.
[[nodiscard]] loop::Isotropy isotropy_of(const IsotropyRecord& record, const systems::Description& system);

/// Look for small oscillations around one equilibrium.
struct SweepWork {
  static constexpr const char* payload_name = "sweep work";
  int index = 0;  ///< of the equilibrium, in sorted order
  std::vector<double> point;
};

/// A family found by a sweep: where and how it starts.
struct FoundMode {
  double period = 0.0;
  loop::Tangent direction;  ///< of a loop with cutoff `cutoff`
  int cutoff = 0;
  IsotropyRecord isotropy;
  bool one_direction = true;  ///< a symmetry maps one direction of the start onto the other
};

struct SweepOutcome {
  static constexpr const char* payload_name = "sweep outcome";
  int index = 0;
  std::vector<double> point;
  std::vector<FoundMode> modes;       ///< longest period first
  std::vector<std::string> rejected;  ///< a sentence a dip
};

/// Where a family stands in the tree. Keys are paths: a crossing's key is its family's branch, its ordinal along it and its
/// sector ("0000.0001/003.q4.j1"); a family born there adds the direction's number; a branch adds + or - where both sides
/// of the direction lead to different orbits of the family.
struct Lineage {
  std::string family;    ///< key of the family
  std::string crossing;  ///< key of the crossing where it was born; empty for base families
  int depth = 0;         ///< 0 for base families
  int multiplicity = 1;  ///< times around the parent's orbit
  int side = 1;          ///< of the direction; -1: steps are counted backwards
};

/// Follow one family from its start to its end.
struct BranchWork {
  static constexpr const char* payload_name = "branch work";
  std::string key;
  std::string name;  ///< for progress; final names are given at the end
  Lineage lineage;
  LoopRecord base;          ///< the equilibrium, or the crossing's orbit as many times around as it takes
  loop::Tangent direction;  ///< in its modes
  IsotropyRecord isotropy;
  double amplitude = 0.0;  ///< |dz(s = 0)| of the first orbit; 0: the scene's
};

/// A branch has come to an orbit with more symmetry than its own: a crossing of another family, or of its own.
struct ArrivalRecord {
  double period = 0.0;  ///< where it meets, by interpolation
  double energy = 0.0;
  LoopRecord near;  ///< an orbit of the branch shortly before
};

struct BranchOutcome {
  static constexpr const char* payload_name = "branch outcome";
  std::string key;
  int orbits = 0;
  double period_from = 0.0;
  double period_to = 0.0;
  double energy_from = 0.0;
  double energy_to = 0.0;
  double last_period = 0.0;
  double last_energy = 0.0;
  int last_cutoff = 0;
  continuation::Ending end;
  std::vector<ArrivalRecord> arrival;  ///< one or none
  std::vector<std::string> remarks;
  int limited_by = 0;        ///< Limit: with wider ones the branch would have gone on
  std::string before_limit;  ///< the state (queue::Task) from which it would, without children; empty: from its start
};

/// An orbit of a family with its place.
struct KnownOrbit {
  double position = 0.0;
  LoopRecord loop;
};

/// Locate an event of a family, and find what leaves there.
struct LocateWork {
  static constexpr const char* payload_name = "locate work";
  std::string key;   ///< of the crossing
  std::string name;  ///< of the branch, for progress
  Lineage lineage;   ///< of the family that it lies on
  IsotropyRecord isotropy;
  std::vector<KnownOrbit> known;
  double before_first = 0.0;  ///< arclength from the crossing where the family was born to its first orbit
  int event = 0;              ///< bifurcation::Event::Kind
  int function = 0;           ///< bifurcation::TestFunction::Kind
  int q = 1;
  int j = 0;
  bool tangency = false;
  double from = 0.0;
  double to = 0.0;
};
void set_event(LocateWork& work, const bifurcation::Event& event);
[[nodiscard]] bifurcation::Event event_of(const LocateWork& work);

/// One direction in which a family leaves a crossing, as rank 0 remembers it to know arrivals again (few harmonics).
struct LeavingRecord {
  std::string key;  ///< of the family
  IsotropyRecord isotropy;
  bool both_sides = false;
  LoopRecord base;
  loop::Tangent direction;
};

struct LocateOutcome {
  static constexpr const char* payload_name = "locate outcome";
  std::string key;
  Lineage lineage;
  double arclength = 0.0;
  double period = 0.0;
  double energy = 0.0;
  std::optional<archive::CrossingKind> kind;  ///< none: nothing crosses there
  int multiplicity = 1;
  int kernel_dimension = 0;
  double residual = 0.0;
  double kernel_singular_value = 0.0;
  double next_singular_value = 0.0;
  double test_value = 0.0;
  std::vector<double> state;
  int q = 1;
  int j = 0;
  int fundamental_order = 1;
  std::vector<LeavingRecord> leaving;
  std::string remark;
  int limited_by = 0;  ///< Limit: with wider ones more would have been looked for
};

/// Find the first orbit of a family along a direction.
struct StartWork {
  static constexpr const char* payload_name = "start work";
  BranchWork branch;  ///< with the amplitude to try first
};

struct StartOutcome {
  static constexpr const char* payload_name = "start outcome";
  int limited_by = 0;  ///< Limit: with wider ones another amplitude would have served, or a first one
};

/// Arclength along the family of a position along one branch of it: the other side of the crossing counts backwards.
[[nodiscard]] double signed_arclength(const Lineage& lineage, double before_first, double position);

/// A task of each kind. Sweeps run first, then by depth: branches, what they crossed, what leaves there.
[[nodiscard]] queue::Task task_of(const SweepWork& work);
[[nodiscard]] queue::Task task_of(const BranchWork& work);
[[nodiscard]] queue::Task task_of(const LocateWork& work);
[[nodiscard]] queue::Task task_of(const StartWork& work);

[[nodiscard]] std::string pack(const SweepWork& work);
[[nodiscard]] std::string pack(const SweepOutcome& outcome);
[[nodiscard]] std::string pack(const BranchWork& work);
[[nodiscard]] std::string pack(const BranchOutcome& outcome);
[[nodiscard]] std::string pack(const LocateWork& work);
[[nodiscard]] std::string pack(const LocateOutcome& outcome);
[[nodiscard]] std::string pack(const StartWork& work);
[[nodiscard]] std::string pack(const StartOutcome& outcome);
/// Each throws EnvironmentError for bytes that hold something else, another version, or a torn message.
[[nodiscard]] SweepWork unpack_sweep_work(const std::string& bytes);
[[nodiscard]] SweepOutcome unpack_sweep_outcome(const std::string& bytes);
[[nodiscard]] BranchWork unpack_branch_work(const std::string& bytes);
[[nodiscard]] BranchOutcome unpack_branch_outcome(const std::string& bytes);
[[nodiscard]] LocateWork unpack_locate_work(const std::string& bytes);
[[nodiscard]] LocateOutcome unpack_locate_outcome(const std::string& bytes);
[[nodiscard]] StartWork unpack_start_work(const std::string& bytes);
[[nodiscard]] StartOutcome unpack_start_outcome(const std::string& bytes);

/// The start that a branch's work describes.
[[nodiscard]] continuation::Start start_of(const BranchWork& work, const systems::Description& system);

}  // namespace orbweaver::survey
