#pragma once

#include "graph_system.hpp"
#include "linear_quantities.hpp"
#include "reduced_structure.hpp"

namespace orbweaver::systems {

/// The equations of a reduced system from those of the whole one. Gradients are taken from the graph, so that the
/// redundant coordinates have as many digits as are asked for.
[[nodiscard]] Equations reduced_equations(const GraphSystem& whole, const LinearQuantities& linear, const Chart& chart);

}  // namespace orbweaver::systems
