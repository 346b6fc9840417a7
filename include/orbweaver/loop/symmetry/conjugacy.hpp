#pragma once

#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::loop {

/// Whether a symmetry of the system (a reversing one among them) and another phase take loops with the one isotropy to
/// loops with the other: R@0 and R@1/2, or reflections in two axes of a triangle.
[[nodiscard]] bool are_conjugate(const systems::Structure& system, const Isotropy& a, const Isotropy& b);

}  // namespace orbweaver::loop
