#pragma once

#include <vector>

#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::loop {

/// Even number of nodes on which means over time of functions of the state are accurate:
/// FourierGrid::nodes_for(cutoff), or more where the time map's density has higher harmonics (nodes_to_resolve).
[[nodiscard]] int nodes_for(const Loop& loop);

/// States at nodes equidistant in s: mean over time of g = sum_j weights_j g(z_j).
struct Samples {
  int nodes = 0;
  std::vector<double> weights;  ///< density_j / nodes
  std::vector<double> states;   ///< dimension x nodes, component-major, windings included
};
[[nodiscard]] Samples samples_of(const Loop& loop);
/// The same at that many nodes, more than twice the cutoff.
[[nodiscard]] Samples samples_of(const Loop& loop, int nodes);

/// sqrt of the mean over a period of |z(t) - w(t)|^2, periods scaled to one; cutoffs and time maps may differ,
/// dimensions and windings must agree. By Parseval's equation where both maps are the identity.
[[nodiscard]] double mean_distance(const Loop& a, const Loop& b);

/// sqrt of the mean over a period of |dz/dt|^2.
[[nodiscard]] double rms_speed(const Loop& loop);

/// sqrt of the mean over a period of |z - mean z|^2 (less the winding, n 2 pi t/T): how far the loop is from a constant
/// one.
[[nodiscard]] double rms_amplitude(const Loop& loop);

/// sqrt of the mean over a period of |z|^2 (less the winding): the scale of rounding errors in the modes.
[[nodiscard]] double rms_size(const Loop& loop);

/// The mean over a period of z (less the winding): a_0 where the time map is the identity.
[[nodiscard]] std::vector<double> mean_state(const Loop& loop);

}  // namespace orbweaver::loop
