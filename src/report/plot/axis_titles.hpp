#pragma once

#include <cstddef>
#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

// What stands beside an axis, with its unit where the system's parameters have units.
[[nodiscard]] std::string period_title(const archive::Archive& atlas);
/// Of the energy, or of the parameter that moves along the families.
[[nodiscard]] std::string level_title(const archive::Archive& atlas);
[[nodiscard]] std::string coordinate_title(const archive::Archive& atlas, std::size_t coordinate);
/// Of a length in a picture of the system itself.
[[nodiscard]] std::string length_title(const archive::Archive& atlas, const char* name);
/// "double pendulum": the system, for the title of a slide.
[[nodiscard]] std::string system_title(const archive::Archive& atlas);

}  // namespace orbweaver::report
