#pragma once

#include <string>
#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::survey {

/// Look for small oscillations around one equilibrium, or, where a parameter moves, for the Hopf points of its curve;
/// or correct an orbit that the scene gives.
struct SweepWork {
  static constexpr const char* payload_name = "sweep work";
  int index = 0;  ///< of the equilibrium, in sorted order; states come behind
  std::vector<double> point;
  double period = 0.0;  ///< of an orbit through `point`; 0: an equilibrium

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, index, point, period);
  }
};

/// A family found by a sweep: where and how it starts.
struct FoundMode {
  double period = 0.0;
  int place = 0;            ///< among all families of the equilibrium, those outside the range included
  loop::Tangent direction;  ///< of a loop with cutoff `cutoff`
  int cutoff = 0;
  loop::Isotropy isotropy;
  bool one_direction = true;  ///< a symmetry maps one direction of the start onto the other
  double amplitude = 0.0;     ///< |dz(s = 0)| of the first orbit; 0: the scene's
  loop::Loop base;            ///< where it is not the sweep's equilibrium: a Hopf point, or an orbit of the family
  bool base_is_orbit = false;
  double distance = 0.0;  ///< of a Hopf point from the equilibrium, along the curve of equilibria

  static constexpr int wire_version = 5;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, place, direction, cutoff, isotropy, one_direction, amplitude, base,
                            base_is_orbit, distance);
  }
};

/// A period that several oscillations share (bifurcation::OscillationKernel): an entry a family.
struct KernelRecord {
  double period = 0.0;
  int dimension = 0;
  bool is_definite = false;
  int not_isolated = 0;
  std::vector<int> places;
  std::vector<int> images;
  std::vector<int> repetitions;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, dimension, is_definite, not_isolated, places, images, repetitions);
  }
};

/// Families with a period outside the range of the sweep.
struct LeftOutMode {
  double period = 0.0;
  int place = 0;  ///< of the first
  int families = 1;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, place, families);
  }
};

struct SweepOutcome {
  static constexpr const char* payload_name = "sweep outcome";
  int index = 0;
  std::vector<double> point;
  std::vector<FoundMode> modes;       ///< longest period first
  std::vector<std::string> rejected;  ///< a sentence a dip
  std::vector<LeftOutMode> left_out;  ///< longest period first
  std::vector<KernelRecord> kernels;  ///< in the range
  int families = 0;                   ///< of the equilibrium, those left out and undecided included
  double period_from = 0.0;           ///< the range swept
  double period_to = 0.0;

  static constexpr int wire_version = 3;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, index, point, modes, rejected, left_out, kernels, families, period_from,
                            period_to);
  }
};

[[nodiscard]] queue::Task task_of(const SweepWork& work);

[[nodiscard]] std::string pack(const SweepWork& work);
[[nodiscard]] std::string pack(const SweepOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] SweepWork unpack_sweep_work(const std::string& bytes);
[[nodiscard]] SweepOutcome unpack_sweep_outcome(const std::string& bytes);

}  // namespace orbweaver::survey
