#pragma once

#include <string_view>

namespace orbweaver::archive {

/// What happens at a crossing (column `kind` of /crossings).
enum class CrossingKind {
  branch_point,
  period_doubling,
  subharmonic,
  fold_energy,
  fold_period,
  fold_parameter,
  torus,
  krein,
  unknown,  ///< of a file from another version: never written
};
[[nodiscard]] constexpr CrossingKind last_of(CrossingKind) { return CrossingKind::unknown; }

/// "branch-point", ...: as in the file.
[[nodiscard]] std::string_view name_of(CrossingKind kind);
/// The kind with that name; `unknown` for any other text.
[[nodiscard]] CrossingKind crossing_kind_of(std::string_view name);

/// Families are born there: by a multiplier that passes a root of unity.
[[nodiscard]] bool has_sector(CrossingKind kind);
/// The family turns there in period, energy or parameter.
[[nodiscard]] bool is_fold(CrossingKind kind);

}  // namespace orbweaver::archive
