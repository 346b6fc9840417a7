#pragma once

#include <map>
#include <string>
#include <vector>

#include "family.hpp"

namespace orbweaver::survey {

/// Arclengths on families of crossings, which know those on their branches.
class Arclengths {
 public:
  explicit Arclengths(const std::vector<Family>& families) {
    for (const Family& family : families) _births[family.key] = family.birth;
  }

  /// Of a crossing on one of the families.
  [[nodiscard]] double of(const LocateOutcome& crossing) const {
    const double birth = _births.at(crossing.lineage.family);
    return crossing.lineage.side > 0 ? crossing.arclength : birth + crossing.arclength;
  }

 private:
  std::map<std::string, double> _births;  // by key
};

}  // namespace orbweaver::survey
