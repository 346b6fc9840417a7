#pragma once

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Every crossing's place is known to the scene's tolerance, or as well as two computations of one orbit have to agree:
/// what a location leaves open of a place that is not flat (5e-10 at most of double_pendulum.yaml's 27) is far less.
class OpenPlaces final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    const double tolerance = std::fmax(evidence.scene.continuation.tolerance, continuation::same_orbit_tolerance);
    for (std::size_t row = 0; row < evidence.tree.crossings.size(); ++row) {
      // What turns at a fold has no bound of its own, only a scatter (bifurcation/place_error.hpp).
      if (archive::is_fold(evidence.tree.atlas.crossing_kinds()[row])) continue;
      const TreeCrossing& crossing = evidence.tree.crossings[row];
      const double in_period = crossing.place_error_period / crossing.period;
      const double in_level = crossing.place_error_level / crossing.level_scale;
      if (!(std::fmax(in_period, in_level) > tolerance)) continue;
      Finding finding;
      finding.kind = FindingKind::open_place;
      finding.severity = Severity::undecided;
      finding.family = crossing.family;
      finding.crossing = static_cast<int>(row);
      finding.period = crossing.period;
      finding.level = crossing.level;
      finding.deviation = crossing.place_error;
      finding.detail = fmt::format(", {:.1e} in T", crossing.place_error_period);
      if (!std::isnan(crossing.level))
        finding.detail += fmt::format(", {:.1e} in {}", crossing.place_error_level,
                                      crossing.parameter.empty() ? "E" : crossing.parameter);
      found.push_back(std::move(finding));
    }
    return found;
  }
};

}  // namespace orbweaver::survey
