#pragma once

#include <string>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::survey {

/// Where a family stands in the tree. Keys are paths: a crossing's key is its family's branch, its ordinal along it and
/// its sector ("0000.0001/003.q4.j1"); a family born there adds the direction's number; a branch adds + or - where both
/// sides of the direction lead to different orbits of the family.
struct Lineage {
  std::string family;    ///< key of the family
  std::string crossing;  ///< key of the crossing where it was born; empty for base families
  int depth = 0;         ///< 0 for base families
  int multiplicity = 1;  ///< times around the parent's orbit
  int side = 1;          ///< of the direction; -1: steps are counted backwards

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family, crossing, depth, multiplicity, side);
  }
};

/// Arclength along the family of a position along one branch of it: from the first orbit, or, of the other side, which
/// counts backwards, from the crossing, `before_first` from the side's first orbit.
[[nodiscard]] double signed_arclength(const Lineage& lineage, double before_first, double position);

}  // namespace orbweaver::survey
