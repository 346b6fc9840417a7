#pragma once

#include "orbweaver/numerics/quad.hpp"
#include "orbweaver/systems/formulas.hpp"

namespace orbweaver::systems {

/// f and df/dz at one state in quadruple precision; sizes dimension, and dimension x dimension. Throws MisuseError for
/// a state of another dimension.
void linearize_formulas(const Formulas& formulas, const numerics::QuadVector& z, numerics::QuadVector& f,
                        numerics::QuadMatrix& jacobian);

}  // namespace orbweaver::systems
