#pragma once

#include <span>
#include <vector>

#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// How the inputs and parameters of a graph move: nodes by their number, -1 for what stands still.
struct Direction {
  std::vector<int> inputs;
  std::vector<int> parameters;
};

/// The derivatives of the nodes `outputs` along a direction, as nodes; -1 where nothing moves them.
[[nodiscard]] std::vector<int> derivatives_along(Graph& graph, std::span<const int> outputs,
                                                 const Direction& direction);

/// The derivatives of the node `output` by the inputs of these numbers, by one sweep backwards; -1 where it does not
/// depend on one.
[[nodiscard]] std::vector<int> gradient(Graph& graph, int output, std::span<const int> inputs);

/// Entry (i, l) of df_i/dz_l at [i * inputs + l], the constant 0 where there is none.
[[nodiscard]] std::vector<int> jacobian(Graph& graph, std::span<const int> outputs, int inputs);

/// The nodes `outputs` with other nodes in the place of inputs and parameters; numbers beyond the lists stay.
[[nodiscard]] std::vector<int> substituted(Graph& graph, std::span<const int> outputs, const Direction& others);

}  // namespace orbweaver::model
