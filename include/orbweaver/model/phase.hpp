#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// How a graph that names time becomes one that names the phase of a drive.
struct Phased {
  std::vector<int> outputs;
  int frequency = -1;  ///< the phase's rate; -1 where the outputs do not depend on time
  /// What is wrong, for a message; empty where all is well.
  std::string obstacle;
};

/// Time is the input of number `time`, and stands as c t + (something without t) within sines and cosines alone; the
/// numbers c are rational multiples of one another, for `values` of the parameters and any others. The phase, the input
/// of number `phase`, turns with their greatest common divisor, or with `frequency`.
[[nodiscard]] Phased with_phase(Graph& graph, std::span<const int> outputs, int time, int phase,
                                std::optional<int> frequency, std::span<const double> values);

}  // namespace orbweaver::model
