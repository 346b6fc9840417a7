#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace orbweaver::systems {

/// Names and texts of the systems in drivers/systems, which the program holds.
[[nodiscard]] const std::vector<std::pair<std::string_view, std::string_view>>& shipped_texts();

}  // namespace orbweaver::systems
