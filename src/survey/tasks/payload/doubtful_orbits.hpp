#pragma once

#include <vector>

#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::survey {

/// Orbits whose certificates do not hold, all with one verdict.
struct DoubtfulOrbits {
  certificate::Judgement worst;  ///< whose error is the largest in parts of what is allowed
  int count = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, worst, count);
  }
};

/// Adds orbits to the entry of their verdict; certificates that hold add nothing.
void add(std::vector<DoubtfulOrbits>& doubtful, const DoubtfulOrbits& orbits);

}  // namespace orbweaver::survey
