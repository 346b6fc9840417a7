#pragma once

#include <string>
#include <vector>

#include "source.hpp"

namespace orbweaver::scene {

/// Splits "limits.period=30" at the first '='; the value is YAML. Throws core::InputError naming the override.
[[nodiscard]] Override parse_override(const std::string& words);

/// `root` with the overrides set in their order; maps on the way that are missing are created. The nodes of `root` are
/// shared, never changed, so that anchors do not carry an override elsewhere. Throws core::InputError where a path runs
/// through something that is not a map.
[[nodiscard]] YAML::Node apply_overrides(const YAML::Node& root, const std::vector<Override>& overrides);

}  // namespace orbweaver::scene
