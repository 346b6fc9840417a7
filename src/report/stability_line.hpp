#pragma once

#include <cstddef>
#include <string>

#include "orbit_stability.hpp"
#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// How stability goes along a family, in at most `cells` characters from its first orbit to its last: the lowest where
/// all orbits of a piece are stable, higher ones the faster the fastest of them leaves its neighbourhood, by the
/// largest multiplier's absolute value (up to 1.8, 3.2, 10, 100, 1000, 10000, more), `?` where it is not known. Blocks
/// of Unicode, or `_.:-=+*#`. Empty where nothing is known.
[[nodiscard]] std::string stability_line(const archive::Archive& atlas, const OrbitStability& stability,
                                         std::size_t family, std::size_t cells, bool unicode);

}  // namespace orbweaver::report
