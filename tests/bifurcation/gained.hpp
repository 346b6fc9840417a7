#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/symmetry_watch.hpp"

namespace orbweaver::test {

/// "S@1/4", "1@1/3" (three times around a shorter orbit), "R" (at some phase).
inline std::string to_text(const bifurcation::Gained& gained) {
  if (gained.reversing) return gained.name;
  if (gained.shift_numerator == 0) return gained.name + "@0";
  return fmt::format("{}@{}/{}", gained.name, gained.shift_numerator, gained.shift_denominator);
}

/// The first symmetry that the branch passes from one orbit to the next.
inline std::optional<bifurcation::Gained> first_passed(const bifurcation::SymmetryWatch& watch, const loop::Loop& a,
                                                       const loop::Loop& b) {
  std::vector<bifurcation::Gained> all =
      watch.all_passed(bifurcation::SymmetryWatch::see(a), bifurcation::SymmetryWatch::see(b));
  if (all.empty()) return std::nullopt;
  return std::move(all.front());
}

}  // namespace orbweaver::test
