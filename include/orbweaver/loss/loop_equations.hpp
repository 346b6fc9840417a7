#pragma once

#include <memory>

#include <Eigen/Dense>

#include "orbweaver/loop/loop.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::loss {

class BoxScheme;

/// The square system of Newton's method at one loop: residual projected onto the modes of its symmetry type, and the
/// slice's conditions; unknowns are those of the loss and, where a phase condition is held, an unfolding multiple of grad H.
/// Under a time map the residual is taken as w r = (2 pi/T) z' - w f, w the density: the box scheme's cells then differ
/// only by their factor w of the field.
class LoopEquations {
 public:
  LoopEquations(const systems::System& system, const loop::Loop& loop, const Unknowns& unknowns,
                const loop::Subspace& image, const Slice& slice);
  ~LoopEquations();
  LoopEquations(const LoopEquations&) = delete;
  LoopEquations& operator=(const LoopEquations&) = delete;
  LoopEquations(LoopEquations&&) = delete;
  LoopEquations& operator=(LoopEquations&&) = delete;

  /// Number of unfolding columns that make the system square (may be negative or > 1: then it cannot be).
  [[nodiscard]] static int unfoldings(const Unknowns& unknowns, const loop::Subspace& image, const Slice& slice) {
    return image.size() + static_cast<int>(slice.conditions().cols()) - unknowns.size();
  }

  [[nodiscard]] int size() const { return _unknowns.size() + _unfoldings; }
  [[nodiscard]] double loss() const { return _linearization.loss(); }
  [[nodiscard]] const Linearization& linearization() const { return _linearization; }

  /// Projected residual, zeros for the conditions (they hold exactly along the iteration).
  [[nodiscard]] Eigen::VectorXd residual() const;
  /// The Jacobian times a vector of unknowns.
  [[nodiscard]] Eigen::VectorXd apply(const Eigen::VectorXd& x) const;
  /// An approximate inverse from the box scheme on 2K + 1 nodes.
  [[nodiscard]] Eigen::VectorXd precondition(const Eigen::VectorXd& r) const;
  /// Builds and factors the box scheme (before the first precondition).
  void factor(const systems::System& system, const loop::Loop& loop);

 private:
  [[nodiscard]] Eigen::VectorXd project_nodal(const std::vector<double>& nodal) const;

  const Unknowns& _unknowns;
  const loop::Subspace& _image;
  const Slice& _slice;
  int _unfoldings;
  Linearization _linearization;
  Eigen::VectorXd _unfolding_column;  // projected grad H
  std::unique_ptr<BoxScheme> _box;
};

}  // namespace orbweaver::loss
