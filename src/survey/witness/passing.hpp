#pragma once

#include <vector>

#include "orbweaver/survey/atlas/atlas_tree.hpp"
#include "witness/curve_index.hpp"

namespace orbweaver::survey {

/// A place in period, level and action, in the units of the atlas.
struct PlaceOfOrbit {
  double period = 0.0;
  double level = 0.0;
  double action = 0.0;
  double level_scale = 0.0;  ///< what deviations in level are relative to
};

/// Segments whose family passes within 1e-3 of the place, relatively: what the extrapolation of a branch to where it
/// meets another family may be off (tree/arrivals.cpp).
[[nodiscard]] std::vector<CurveIndex::Segment> passing(const AtlasTree& tree, const CurveIndex& index,
                                                       const PlaceOfOrbit& place);

}  // namespace orbweaver::survey
