#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/loop/curve/loop.hpp"

namespace orbweaver::archive {

/// The loop of row `orbit` of /orbits, to be evaluated by loop::state_at. `angles`: the coordinates that may wind, in
/// the order of the header's winding_names (systems::Structure::angles). Throws MisuseError if there is no such row or
/// `angles` do not fit the header, InputError where the file holds no valid loop there.
[[nodiscard]] loop::Loop loop_of(const Archive& atlas, std::size_t orbit, const std::vector<int>& angles);

/// The same with the coordinates that the archive names. Throws InputError where it names none though some wind: it is
/// from before format_minor 11.
[[nodiscard]] loop::Loop loop_of(const Archive& atlas, std::size_t orbit);

}  // namespace orbweaver::archive
