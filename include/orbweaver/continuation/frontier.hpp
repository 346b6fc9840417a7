#pragma once

#include <vector>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/equations/preconditioner.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/curve/time_map.hpp"

namespace orbweaver::continuation {

/// How finely the points of a branch are resolved.
struct Resolution {
  int size = 0;  ///< cells of the fundamental domain (collocation), or the cutoff (whole loops)
  loop::TimeMap time_map;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, size, time_map);
  }
};

/// A point of a branch in the numbers of the problem that corrects it: the loop, then the scalars (T first).
struct TracePoint {
  std::vector<double> values;
  double parameter = 0.0;  ///< along the branch: the predictor's polynomials run in it

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, values, parameter);
  }
};

/// What a point problem keeps from one correction to the next.
struct ProblemState {
  Resolution resolution;
  double amplitude = 0.0;    ///< rms distance of the last orbit from its mean: small loops are solved in proportion
  double held_energy = 0.0;  ///< of all orbits, where the family holds the energy
  std::vector<double> factor_point;       ///< where the preconditioner was built; empty = to be built anew
  std::vector<double> factor_conditions;  ///< and under which conditions
  equations::Preconditioner preconditioner = equations::Preconditioner::box;  ///< of collocation: the cheapest that did
  int least_size = 0;  ///< of a resolution: a step failed at half of it that the harmonics did not explain

  static constexpr int wire_version = 4;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, resolution, amplitude, held_energy, factor_point, factor_conditions,
                            preconditioner, least_size);
  }
};

/// How near the orbits of a branch have come to the zeros of one guard.
struct GuardTrace {
  double least = 0.0;           ///< smallest value over the last orbit
  double fallen_from = 0.0;     ///< that of the orbit at which it last rose; of the first one if it never did
  std::vector<double> earlier;  ///< those of some orbits before the last one, oldest first

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, least, fallen_from, earlier);
  }
};

/// Everything a step depends on: a step is a pure function of it and of the options.
struct Frontier {
  Orbit orbit;               ///< the last one, as it was accepted
  loop::Tangent tangent;     ///< unit direction of the branch there, in the modes of orbit.loop; empty: not asked for
  double next_length = 0.0;  ///< step to try next, in the problem's own length
  double last_increment = 0.0;  ///< arclength of the last step
  loop::Loop first;             ///< loop of orbit 0
  double first_level = 0.0;     ///< the energy of orbit 0, or what moves instead (`level_of`)
  double first_amplitude = 0.0;
  double earlier_level = 0.0;  ///< that when the period was about a tenth smaller
  double earlier_period = 0.0;
  bool has_come_back = false;    ///< `orbit` is the first one again, of a circle, or lies beyond it by less than a step
  bool on_energy_limit = false;  ///< `orbit` is the last one, at the scene's energy limit,
  bool on_parameter_limit = false;  ///< or at that of the parameter
  std::vector<GuardTrace> guards;   ///< one a guard of the structure
  int on_guard_limit = -1;          ///< the guard at whose limit `orbit` is the last one
  double threshold = 0.0;           ///< under which sqrt(loss) of `orbit` was accepted
  std::vector<TracePoint> points;   ///< the last ones, oldest first; the start itself is the very first
  ProblemState problem;

  static constexpr int wire_version = 4;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, orbit, tangent, next_length, last_increment, first, first_level, first_amplitude,
                            earlier_level, earlier_period, has_come_back, on_energy_limit, on_parameter_limit, guards,
                            on_guard_limit, threshold, points, problem);
  }
};

}  // namespace orbweaver::continuation
