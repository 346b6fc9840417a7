#pragma once

#include <cstddef>
#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Row of /families of the family with this name. Throws InputError where there is none.
[[nodiscard]] std::size_t family_row(const archive::Archive& atlas, const std::string& name);

/// Rows of /orbits.
struct OrbitRange {
  std::size_t first = 0;
  std::size_t count = 0;
};
/// Those of a row of /families.
[[nodiscard]] OrbitRange orbits_of(const archive::Archive& atlas, std::size_t family);

/// The row of /orbits of a step of a family. Throws InputError where it has no such step.
[[nodiscard]] std::size_t orbit_row(const archive::Archive& atlas, std::size_t family, int step);

}  // namespace orbweaver::report
