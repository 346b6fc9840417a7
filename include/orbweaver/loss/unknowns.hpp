#pragma once

#include <span>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"

namespace orbweaver::loss {

/// What is solved for: the coordinates of a perturbation in a subspace and, if `period` is set, the period as last
/// entry. A vector of unknowns u is always relative to a base loop: u = 0 is the base.
struct Unknowns {
  loop::Subspace subspace;
  bool period = true;

  [[nodiscard]] int size() const { return subspace.size() + (period ? 1 : 0); }
  /// base + u; the period of the result may be anything finite, also <= 0 (the loss refuses that).
  [[nodiscard]] loop::Loop moved(const loop::Loop& base, std::span<const double> u) const;
  /// The orthogonal projection of `to` - `from` onto the unknowns (same cutoff as the subspace, same time map).
  [[nodiscard]] std::vector<double> difference(const loop::Loop& from, const loop::Loop& to) const;
  /// The orthogonal projection of a tangent onto the unknowns, and the tangent that a vector of unknowns is.
  [[nodiscard]] std::vector<double> coordinates_of(const loop::Tangent& tangent) const;
  [[nodiscard]] loop::Tangent tangent_of(std::span<const double> u) const;
  /// dz/d(2 pi t/T) = z'/(2 pi phi') of the loop as a vector of unknowns: the direction of a time shift (period entry 0).
  [[nodiscard]] std::vector<double> time_shift_direction(const loop::Loop& loop) const;
};

}  // namespace orbweaver::loss
