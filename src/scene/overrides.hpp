#pragma once

#include <string>
#include <vector>

#include "fields.hpp"

namespace orbweaver::scene {

/// Splits each "limits.period=30" at the first '='; the value is YAML. Throws core::InputError with the override, also
/// where there are more of them, or more bytes in all, than a scene could hold.
[[nodiscard]] std::vector<Override> parse_overrides(const std::vector<std::string>& overrides);

/// `root` with the overrides set in their order; maps on the way that are missing are created. The nodes of `root` are
/// shared, never changed, so that anchors do not carry an override elsewhere. Throws core::InputError where a path runs
/// through something that is not a map.
[[nodiscard]] YAML::Node apply_overrides(const YAML::Node& root, const std::vector<Override>& overrides);

}  // namespace orbweaver::scene
