#pragma once

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::test {

/// What holds for a system whose states are moved by `offset`: all symmetries, now affine.
[[nodiscard]] inline systems::Structure translated(systems::Structure structure, const Eigen::VectorXd& offset) {
  const systems::AffineMap there{Eigen::MatrixXd::Identity(offset.size(), offset.size()), offset};
  for (auto* symmetries : {&structure.equivariances, &structure.reversors})
    for (systems::Symmetry& s : *symmetries) s.map = there * s.map * there.inverse();
  return structure;
}

[[nodiscard]] inline loop::Loop translated(loop::Loop loop, const Eigen::VectorXd& offset) {
  for (int i = 0; i < loop.dimension; ++i) loop.cosine(0, i) += offset(i);
  return loop;
}

}  // namespace orbweaver::test
