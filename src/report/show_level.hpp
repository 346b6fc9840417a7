#pragma once

#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// What tells the orbits of a family apart beside the period: the energy, or the parameter that moves.
struct Level {
  std::string title;
  const char* column;  ///< of /orbits and /crossings
};
[[nodiscard]] Level level_of(const archive::Archive& atlas);

}  // namespace orbweaver::report
