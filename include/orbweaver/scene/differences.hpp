#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"

namespace orbweaver::scene {

/// What a difference between two scenes means for a survey begun with the first that is to go on with the second.
enum class Change {
  free,      ///< no family depends on it
  widened,   ///< a limit that lies farther out: what ended there goes on
  narrowed,  ///< a limit that lies farther in, at one of its ends at least
  other,     ///< anything else: another survey
};

/// Limits that a survey which goes on may widen.
enum class LimitKey { period, energy, parameter, guards, steps, depth, families };

struct Difference {
  std::string key;                ///< as users write it: "limits.period"
  std::optional<LimitKey> limit;  ///< where the key is one
  /// As a scene would say it, defaults filled in: "30", "0.5deg" ("0.01" without angles), "[-.inf, 2]"; empty where it
  /// has no value.
  std::string before;
  std::string now;
  Change change = Change::other;
};

/// The keys in which two checked scenes differ. What counts is the values as they were read, defaults included:
/// comments, notation and units (where both give the same double) do not. A key of the texts that this function does
/// not know is compared as written, and is `other` where it differs.
[[nodiscard]] std::vector<Difference> differences(const Scene& before, const Scene& now);

}  // namespace orbweaver::scene
