#pragma once

#include <string>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/systems/description.hpp"

namespace orbweaver::survey {

/// Kinds of tasks.
inline constexpr const char* sweep_kind = "sweep";
inline constexpr const char* branch_kind = "branch";

/// Look for small oscillations around one equilibrium.
struct SweepWork {
  static constexpr const char* payload_name = "sweep work";
  int index = 0;  ///< of the equilibrium, in sorted order
  std::vector<double> point;
};

/// A family found by a sweep: where and how it starts.
struct FoundMode {
  double period = 0.0;
  std::vector<double> direction;  ///< modes of a loop with cutoff `cutoff`
  int cutoff = 0;
  std::vector<std::string> isotropy;  ///< generators: names,
  std::vector<int> reversing;         ///< whether each reverses time,
  std::vector<int> shift_numerators;  ///< and its shift
  std::vector<int> shift_denominators;
  bool one_direction = true;  ///< a symmetry maps one direction of the start onto the other
};

struct SweepOutcome {
  static constexpr const char* payload_name = "sweep outcome";
  int index = 0;
  std::vector<double> point;
  std::vector<FoundMode> modes;       ///< longest period first
  std::vector<std::string> rejected;  ///< a sentence a dip
};

/// Follow one family from its start to its end.
struct BranchWork {
  static constexpr const char* payload_name = "branch work";
  std::string key;
  std::string name;
  std::vector<double> point;
  FoundMode start;
  int sign = 1;  ///< along or against the start's direction
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
  std::string end_reason;
};

/// A task of each kind: sweeps run before branches, branches in order of their keys.
[[nodiscard]] queue::Task task_of(const SweepWork& work);
[[nodiscard]] queue::Task task_of(const BranchWork& work);

[[nodiscard]] std::string pack(const SweepWork& work);
[[nodiscard]] std::string pack(const SweepOutcome& outcome);
[[nodiscard]] std::string pack(const BranchWork& work);
[[nodiscard]] std::string pack(const BranchOutcome& outcome);
/// Each throws EnvironmentError for bytes that hold something else, another version, or a torn message.
[[nodiscard]] SweepWork unpack_sweep_work(const std::string& bytes);
[[nodiscard]] SweepOutcome unpack_sweep_outcome(const std::string& bytes);
[[nodiscard]] BranchWork unpack_branch_work(const std::string& bytes);
[[nodiscard]] BranchOutcome unpack_branch_outcome(const std::string& bytes);

/// Generators as they travel, and back with the matrices that `system` declares for their names.
void set_isotropy(FoundMode& mode, const loop::Isotropy& isotropy);
[[nodiscard]] loop::Isotropy isotropy_of(const FoundMode& mode, const systems::Description& system);

/// The start that a branch's work describes.
[[nodiscard]] continuation::Start start_of(const BranchWork& work, const systems::Description& system);

}  // namespace orbweaver::survey
