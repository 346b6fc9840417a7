#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// A branch whose task, or the start before it, has ended.
struct EndedBranch {
  Lineage lineage;
  std::string name;  ///< of a base family
  loop::Isotropy isotropy;
  std::optional<BranchOutcome> outcome;  ///< without loops
  bool failed = false;
  std::string reason;
};

/// By key.
using EndedBranches = std::map<std::string, EndedBranch>;
using Crossings = std::map<std::string, LocateOutcome>;

/// A side of a family: its branch with its key.
using FamilySide = const EndedBranches::value_type*;

/// A family with its branches: one, or one a side.
struct Family {
  std::string key;
  Lineage lineage;
  std::vector<FamilySide> sides;  ///< + first
  std::string name;
  double birth = 0.0;  ///< arclength of the crossing where it was born; 0: of none
};

}  // namespace orbweaver::survey
