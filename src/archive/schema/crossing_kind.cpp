#include "orbweaver/archive/schema/crossing_kind.hpp"

namespace orbweaver::archive {

std::string_view name_of(CrossingKind kind) {
  switch (kind) {
    case CrossingKind::branch_point: return "branch-point";
    case CrossingKind::period_doubling: return "period-doubling";
    case CrossingKind::subharmonic: return "subharmonic";
    case CrossingKind::fold_energy: return "fold-energy";
    case CrossingKind::fold_period: return "fold-period";
    case CrossingKind::fold_parameter: return "fold-parameter";
    case CrossingKind::torus: return "torus";
    case CrossingKind::krein: return "krein";
    case CrossingKind::unknown: return "unknown";
  }
  return "unknown";
}

CrossingKind crossing_kind_of(std::string_view name) {
  for (int n = 0; n < static_cast<int>(CrossingKind::unknown); ++n)
    if (const auto kind = static_cast<CrossingKind>(n); name_of(kind) == name) return kind;
  return CrossingKind::unknown;
}

bool has_sector(CrossingKind kind) {
  return kind == CrossingKind::branch_point || kind == CrossingKind::period_doubling ||
         kind == CrossingKind::subharmonic;
}

bool is_fold(CrossingKind kind) {
  return kind == CrossingKind::fold_energy || kind == CrossingKind::fold_period || kind == CrossingKind::fold_parameter;
}

}  // namespace orbweaver::archive
