#pragma once

#include <memory>
#include <vector>

#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// The system told in `scales`: y = z / s obeys dy/dt' = (time / s) f(s y) with t' = t / time, its conserved quantities
/// are divided by theirs, its action density by that of the energy, its symmetries act on y. Guards keep their values.
/// The system itself where all scales are 1, so that nothing is spent on them. With powers of two each number is that
/// of the system times a power of two, to the last bit. Throws MisuseError for scales of other sizes, scales that are
/// not positive, other ones than 1 for angles, different ones for coordinates that a symmetry mixes, and for a system
/// that is scaled already.
[[nodiscard]] std::shared_ptr<const System> scaled(std::shared_ptr<const System> system, const Scales& scales);

/// For each coordinate the first of those that must have its scale, since symmetries mix them.
[[nodiscard]] std::vector<std::size_t> mixed_coordinates(const Structure& structure);

}  // namespace orbweaver::systems
