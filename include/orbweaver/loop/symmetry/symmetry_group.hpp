#pragma once

#include <functional>
#include <vector>

#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::loop {

/// A finite group of spatio-temporal symmetries with all its elements, modulo whole turns of the angles.
class SymmetryGroup {
 public:
  /// What `generators` generate. Throws MisuseError where that are more than 1000.
  SymmetryGroup(const systems::Structure& structure, const Isotropy& generators);
  /// What the symmetries that a system declares generate, time apart: all shifts are 0.
  [[nodiscard]] static SymmetryGroup of_space(const systems::Structure& structure);

  /// The elements that `keeps` holds for, which must form a group.
  [[nodiscard]] SymmetryGroup subgroup(const std::function<bool(const SymmetryElement&)>& keeps) const;

  /// Shifts lie in [0, 1). The identity "1@0" comes first; products of equivariances before what reversors add.
  /// Declared symmetries have their names, products those of their factors.
  [[nodiscard]] const Isotropy& elements() const { return _elements; }
  /// p: the least time shift is T/p.
  [[nodiscard]] int order() const { return _order; }
  /// The fundamental map g, with z(t + T/p) = g z(t). Of those that differ by what keeps every point of the loop: the
  /// first with g^p = 1, if there is one.
  [[nodiscard]] const systems::AffineMap& generator() const { return _generator; }
  /// The first reversor, at any phase; none: nullptr.
  [[nodiscard]] const SymmetryElement* reversor() const;
  /// The first reversor of phase 0: the loop starts on its fixed set.
  [[nodiscard]] const SymmetryElement* reversor_at_start() const;

 private:
  SymmetryGroup() = default;
  void close(const systems::Structure& structure, const Isotropy& generators);
  void set_generator();

  Isotropy _elements;
  std::vector<int> _angles;
  int _order = 1;
  systems::AffineMap _generator;
};

}  // namespace orbweaver::loop
