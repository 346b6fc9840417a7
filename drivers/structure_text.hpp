#pragma once

#include <string>
#include <utility>
#include <vector>

#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::drivers {

/// What holds for a system, as labelled lines: conserved quantities, symmetries, and `families`: what moves along them.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> structure_lines(const systems::ModelInfo& info,
                                                                               const systems::Structure& structure,
                                                                               const std::string& families);

/// "S: th1, th2, w1, w2 -> -th1, -th2, -w1, -w2" for each, or "none".
[[nodiscard]] std::string symmetries_text(const std::vector<std::string>& coordinates, const std::vector<int>& angles,
                                          const std::vector<systems::Symmetry>& symmetries);

/// "conservative: ..." and so on.
[[nodiscard]] std::string family_kind_text(const systems::Structure& structure);

/// "pivot_direction = 30 deg (direction from the vertical)".
[[nodiscard]] std::string parameter_text(const systems::Parameter& parameter, double value);

}  // namespace orbweaver::drivers
