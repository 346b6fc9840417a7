#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// The rows of /equilibria at which something is: equilibria of the scene, both ends of each curve, every point of
/// another kind than `equilibrium`, and neighbours on a curve whose stability differs with no such point between them.
[[nodiscard]] std::vector<std::size_t> notable_equilibria(const archive::Table& equilibria);

}  // namespace orbweaver::report
