#pragma once

#include <string>
#include <vector>

namespace orbweaver::systems {

/// What moves along the families of a system besides T, and what is held there. Without a free parameter families are
/// curves in T.
struct FamilyScalars {
  /// What a conservative family in a parameter holds: its orbits with one parameter value are a curve already.
  enum class Hold { nothing, period, energy };

  std::vector<std::string> free;  ///< parameters that move
  Hold hold = Hold::nothing;

  bool operator==(const FamilyScalars&) const = default;
};

}  // namespace orbweaver::systems
