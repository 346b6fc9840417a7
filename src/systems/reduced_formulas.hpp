#pragma once

#include "linear_quantities.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "reduced_structure.hpp"

namespace orbweaver::systems {

/// The formulas of a reduced system from those of the whole one. Gradients are taken from the graph, so that the
/// redundant coordinates have as many digits as are asked for.
[[nodiscard]] Formulas reduced_formulas(const System& whole, const Formulas& plain, const LinearQuantities& linear,
                                        const Chart& chart);

}  // namespace orbweaver::systems
