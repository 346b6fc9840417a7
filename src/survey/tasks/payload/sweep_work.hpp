#pragma once

#include <string>
#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/queue/task.hpp"
#include "orbweaver/starts/equilibrium_curve.hpp"
#include "orbweaver/starts/linear_modes.hpp"

namespace orbweaver::survey {

/// An orbit that the scene gives (`starts`), near enough for Newton's method.
struct GivenStart {
  /// One of its own; a return of a trajectory is a guess: its orbit is looked for at the trajectory's energy, once
  /// around, and need not exist.
  enum class From { state, archive, loop, trajectory };
  From from = From::state;
  std::string name;     ///< the scene's; empty: by what its family is
  std::string told;     ///< in messages: "starts.states, entry 2"
  double period = 0.0;  ///< of the trajectory from the work's point, or of `guess`
  int symmetry = 0;     ///< after `period` the trajectory goes on as its image (starts::NearReturn)
  int order = 1;        ///< periods after which it closes then
  loop::Loop guess;     ///< empty: the trajectory from the work's point

  [[nodiscard]] bool is_return() const { return from == From::trajectory; }

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, from, name, told, period, symmetry, order, guess);
  }
};

[[nodiscard]] constexpr GivenStart::From last_of(GivenStart::From) { return GivenStart::From::trajectory; }

/// Look for small oscillations around one equilibrium, or, where a parameter moves, for the Hopf points of its curve;
/// or correct an orbit that the scene gives.
struct SweepWork {
  static constexpr const char* payload_name = "sweep work";
  int index = 0;  ///< of the equilibrium, in sorted order; given orbits come behind
  std::vector<double> point;
  std::vector<GivenStart> given{};  ///< one, or none for an equilibrium

  static constexpr int wire_version = 3;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, index, point, given);
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
  double detuning = 0.0;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, dimension, is_definite, not_isolated, places, images, repetitions,
                            detuning);
  }
};

/// Families with a period outside the range of the sweep.
struct LeftOutMode {
  double period = 0.0;
  int place = 0;     ///< of the first
  int families = 1;  ///< or bifurcation::not_counted

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, period, place, families);
  }
};

/// An equilibrium, or a point of its curve in the parameter, with its linear modes: all in the survey's scales.
struct EquilibriumPlace {
  int step = 0;            ///< 0 at the sweep's equilibrium
  double arclength = 0.0;  ///< from there, by chords
  starts::EquilibriumKind kind = starts::EquilibriumKind::regular;
  double parameter = 0.0;  ///< NaN where none moves
  std::vector<double> state;
  double energy = 0.0;  ///< NaN where none is kept
  starts::LinearStability stability = starts::LinearStability::undecided;
  std::vector<double> eigenvalues;  ///< re, im of each, by descending real, then imaginary part
  std::vector<double> periods;      ///< of the oscillations, longest first; NaN behind the last: dimension/2
  std::vector<int> multiplicity;    ///< of each; -1 behind the last
  std::string note;                 ///< why the curve ends there; empty at all others

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, step, arclength, kind, parameter, state, energy, stability, eigenvalues, periods,
                            multiplicity, note);
  }
};

struct SweepOutcome {
  static constexpr const char* payload_name = "sweep outcome";
  int index = 0;
  std::vector<double> point;
  std::vector<FoundMode> modes;             ///< longest period first
  std::vector<std::string> rejected;        ///< a sentence a dip
  std::vector<std::string> without_family;  ///< a sentence an oscillation in a resonance that no family leaves along
  std::vector<LeftOutMode> left_out;        ///< longest period first
  std::vector<KernelRecord> kernels;        ///< in the range
  int families = 0;          ///< of the equilibrium, those left out and undecided included, or `not_counted`
  double period_from = 0.0;  ///< the range swept
  double period_to = 0.0;
  std::vector<EquilibriumPlace> equilibria;  ///< along the curve where there is one

  static constexpr int wire_version = 5;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, index, point, modes, rejected, without_family, left_out, kernels, families,
                            period_from, period_to, equilibria);
  }
};

[[nodiscard]] queue::Task task_of(const SweepWork& work);

[[nodiscard]] std::string pack(const SweepWork& work);
[[nodiscard]] std::string pack(const SweepOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] SweepWork unpack_sweep_work(const std::string& bytes);
[[nodiscard]] SweepOutcome unpack_sweep_outcome(const std::string& bytes);

}  // namespace orbweaver::survey
