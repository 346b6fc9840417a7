#include "show_level.hpp"

#include <utility>

namespace orbweaver::report {

Level level_of(const archive::Archive& atlas) {
  std::string parameter = atlas.moving_parameter();
  if (parameter.empty()) return {"energy", "energy"};
  return {std::move(parameter), "parameter"};
}

}  // namespace orbweaver::report
