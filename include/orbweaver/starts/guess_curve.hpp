#pragma once

#include <functional>
#include <vector>

#include "orbweaver/loop/curve/time_map.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// A curve over one period from which an orbit is corrected, with a mesh that is fine where the motion is fast.
struct GuessCurve {
  double period = 0.0;
  std::function<std::vector<double>(double time)> state;  ///< on [0, period]; angles run on
  std::vector<double> times;                              ///< of the mesh, ascending, from 0 to the period
  /// How fast the motion turns there, |df/dt| / |f|: the time 1/rate is that in which the field changes by its size.
  std::vector<double> rates;

  /// The time at which the motion is fastest, and the rate there.
  struct Fastest {
    double time = 0.0;
    double rate = 0.0;
  };
  [[nodiscard]] Fastest fastest() const;
};

/// A state of a trajectory with its first two derivatives in time.
struct TrajectoryNode {
  double time = 0.0;
  std::vector<double> state;
  std::vector<double> slope;
  std::vector<double> bend;
};

/// The state after a time, which may be negative.
using Advance = std::function<std::vector<double>(const std::vector<double>& state, double time)>;

/// The trajectory through `state` from the time 0 to `time`, which may be negative (nodes then descend), with steps of
/// a part of the time in which the field changes by its size, at most `longest`: between two nodes it is the polynomial
/// of degree 5 that they give. Throws core::NumericalError where it takes more than `most_nodes`, and what `advance`
/// throws.
[[nodiscard]] std::vector<TrajectoryNode> trajectory_nodes(const systems::System& system, const Advance& advance,
                                                           const std::vector<double>& state, double time,
                                                           double longest);

/// The curve through nodes at ascending times, counted from the first one.
[[nodiscard]] GuessCurve curve_through(std::vector<TrajectoryNode> nodes);

/// The curve through `state` with a mesh from the field along it, its steps `longest` at most.
[[nodiscard]] GuessCurve curve_of(const systems::System& system, std::function<std::vector<double>(double time)> state,
                                  double period, double longest);

/// The time map under which s runs as fast as the motion along the curve, smoothed over the time in which it turns.
[[nodiscard]] loop::TimeMap map_to_motion(const GuessCurve& curve);

/// Nodes of a mesh: an orbit that takes more has more harmonics than a survey keeps.
inline constexpr std::size_t most_nodes = std::size_t{1} << 17;

}  // namespace orbweaver::starts
