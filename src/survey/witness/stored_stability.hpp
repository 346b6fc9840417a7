#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

#include "evidence.hpp"
#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::survey {

/// What the archive says of the fundamental map of the orbit in a row, whose order is `order`.
[[nodiscard]] inline spectrum::Stability stored_stability(const Evidence& evidence, std::size_t row, int order) {
  const archive::Archive& atlas = evidence.tree.atlas;
  const std::size_t width = archive::stability_width(atlas.header());
  const std::size_t parts = archive::has_complex_stability(atlas.header()) ? 2 : 1;
  const auto& values = atlas.orbits().reals("fundamental_stability");
  spectrum::Stability stability;
  stability.fundamental_order = order;
  for (std::size_t i = 0; i < width; i += parts)
    stability.fundamental.emplace_back(values[row * width + i], parts == 2 ? values[row * width + i + 1] : 0.0);
  // Of the full period's, which is no smaller but where d(mu^p + mu^-p)/d(mu + 1/mu) is below 1.
  stability.fundamental_error.assign(stability.fundamental.size(),
                                     atlas.orbits().reals("stability_error")[row] * bifurcation::error_margin);
  return stability;
}

/// The order of the fundamental map of a family's orbits.
[[nodiscard]] inline int fundamental_order_of(const Evidence& evidence, const TreeFamily& family) {
  const systems::Structure& structure = evidence.system->structure();
  return loop::SymmetryGroup(structure, loop::isotropy_of(structure, family.isotropy)).order();
}

/// Of an index from 2 on one side of a step on which it passes 2: so steep it does so on a part of the step that
/// rounding does not resolve, and neither the way through nor another family's curve that crosses there is told from
/// the other (docs/limits.md).
inline constexpr double untold_index = 1e13;

/// On which side of 1 the multipliers of a family's orbit are: the sign of the product of all k - 2. 0 where it is not
/// known.
[[nodiscard]] inline int stored_side_of_one(const Evidence& evidence, const TreeFamily& family, std::size_t orbit) {
  if (archive::stability_width(evidence.tree.atlas.header()) == 0) return 0;
  const int order = fundamental_order_of(evidence, family);
  const spectrum::Stability stability = stored_stability(evidence, family.first_orbit + orbit, order);
  if (!bifurcation::are_decided(stability)) return 0;
  const bifurcation::TestFunction at_one{bifurcation::TestFunction::Kind::sector, {1, 0}};
  return bifurcation::evaluate(at_one, evidence.system->structure(), stability).sign();
}

/// How far the nearest index of a family's orbit is from 2. NaN where none is known.
[[nodiscard]] inline double stored_distance_from_two(const Evidence& evidence, const TreeFamily& family,
                                                     std::size_t orbit) {
  double least = std::numeric_limits<double>::quiet_NaN();
  if (archive::stability_width(evidence.tree.atlas.header()) == 0) return least;
  const int order = fundamental_order_of(evidence, family);
  for (const std::complex<double>& k : stored_stability(evidence, family.first_orbit + orbit, order).fundamental)
    least = std::fmin(least, std::abs(k - 2.0));
  return least;
}

/// The steepest index that passes 2 between two orbits of a family so that rounding hides which curve goes on from
/// there: how far it is from 2 beside it. 0 where none does.
[[nodiscard]] inline double untold_between(const Evidence& evidence, const TreeFamily& family, std::size_t from,
                                           std::size_t to) {
  double most = 0.0;
  if (!evidence.system->structure().symplectic) return most;
  int side = 0;
  double before = 0.0;
  for (std::size_t n = from; n <= to; ++n) {
    const int here = stored_side_of_one(evidence, family, n);
    if (here == 0) continue;
    const double away = stored_distance_from_two(evidence, family, n);
    const double steepest = std::fmax(before, away);
    if (side * here < 0 && steepest > untold_index) most = std::fmax(most, steepest);
    side = here;
    before = away;
  }
  return most;
}

}  // namespace orbweaver::survey
