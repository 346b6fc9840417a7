#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/symmetry_watch.hpp"

namespace orbweaver::test {

/// "S@1/4", "1@1/3" (three times around a shorter orbit), "R" (at some phase).
inline std::string to_text(const bifurcation::SymmetryGain& gain) {
  if (gain.reversing) return gain.name;
  if (gain.shift_numerator == 0) return gain.name + "@0";
  return fmt::format("{}@{}/{}", gain.name, gain.shift_numerator, gain.shift_denominator);
}

/// The first symmetry that the branch passes from one orbit to the next.
inline std::optional<bifurcation::SymmetryGain> first_passed(const bifurcation::SymmetryWatch& watch,
                                                             const loop::Loop& a, const loop::Loop& b) {
  std::vector<bifurcation::SymmetryGain> all =
      watch.all_passed(bifurcation::SymmetryWatch::sampled(a), bifurcation::SymmetryWatch::sampled(b));
  if (all.empty()) return std::nullopt;
  return std::move(all.front());
}

}  // namespace orbweaver::test
