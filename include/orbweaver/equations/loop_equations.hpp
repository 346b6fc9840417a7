#pragma once

#include <memory>

#include <Eigen/Dense>

#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::equations {

class BoxScheme;

/// The square system of Newton's method at one loop: residual projected onto the modes of its symmetry type, and the
/// slice's conditions. Unknowns are those of the loss and, where conditions are more than scalars, an unfolding for
/// each conserved quantity whose phase is held: the count decides. Under a time map the residual is taken as w r = (2
/// pi/T) z' - w f, w the density: the box scheme's cells then differ only by their factor w of the field.
///
/// With a team, `factor`, the preconditioner and the products are collective over it, and `factor` and the
/// preconditioner divided by boxes along the loop. Arguments and results are whole, and the same on every member.
class LoopEquations {
 public:
  LoopEquations(const systems::System& system, const loop::Loop& loop, const loss::Unknowns& unknowns,
                const loop::Subspace& image, const loss::Slice& slice, core::Team* team = nullptr);
  ~LoopEquations();
  LoopEquations(const LoopEquations&) = delete;
  LoopEquations& operator=(const LoopEquations&) = delete;
  LoopEquations(LoopEquations&&) = delete;
  LoopEquations& operator=(LoopEquations&&) = delete;

  /// Number of unfoldings that make the system square (negative or more than it conserves: then it cannot be).
  [[nodiscard]] static int unfoldings(const loss::Unknowns& unknowns, const loop::Subspace& image,
                                      const loss::Slice& slice) {
    return image.size() + static_cast<int>(slice.conditions().cols()) - unknowns.size();
  }

  /// Whether there are as many equations as unknowns, unfoldings included as far as the system conserves quantities.
  [[nodiscard]] static bool are_square(const systems::System& system, const loss::Unknowns& unknowns,
                                       const loop::Subspace& image, const loss::Slice& slice);

  [[nodiscard]] int size() const { return _unknowns.size() + _unfoldings; }
  [[nodiscard]] double loss() const { return _linearization.loss(); }
  [[nodiscard]] const loss::Linearization& linearization() const { return _linearization; }

  [[nodiscard]] const loss::Unknowns& unknowns() const { return _unknowns; }
  [[nodiscard]] const loop::Subspace& image() const { return _image; }
  [[nodiscard]] const loss::Slice& slice() const { return _slice; }

  /// Projected residual, zeros for the conditions (they hold exactly along the iteration).
  [[nodiscard]] Eigen::VectorXd residual() const;

  // Products with square matrices of this `size`, in O(K log K). They share scratch space: one at a time.
  using In = Eigen::Ref<const Eigen::VectorXd>;
  using Out = Eigen::Ref<Eigen::VectorXd>;
  /// The Jacobian A times a vector: unknowns and unfoldings to projected residual and conditions.
  void apply(const In& x, Out out) const;
  /// A' times a vector.
  void apply_transposed(const In& y, Out out) const;
  /// P of A = (P w J; conditions): from the rows of the loss's Jacobian (dimension x nodes) to the image's modes.
  void project_rows(const In& rows, Out out) const;
  /// P' y.
  void project_rows_transposed(const In& y, Out rows) const;
  /// Builds and factors the box scheme on 2K + 1 nodes (before the first precondition).
  void factor(const systems::System& system, const loop::Loop& loop);
  /// An approximate inverse of A from the box scheme.
  void precondition(const In& r, Out out) const;
  /// Its transpose.
  void precondition_transposed(const In& u, Out out) const;

 private:
  /// Among all numbers of x: the first scalar, the first of those with a column of their own, and their count.
  [[nodiscard]] Eigen::Index first_scalar() const { return _unknowns.subspace.size(); }
  [[nodiscard]] Eigen::Index first_column() const { return first_scalar() + (_unknowns.has_period() ? 1 : 0); }
  [[nodiscard]] Eigen::Index columns() const { return size() - first_column(); }
  void weigh() const;
  void project_nodal(Out out) const;
  /// The box scheme's solution for the nodal values of `_modes` and the borders of `given`, into `_modes` and `out`.
  void solve_boxes(const In& given, Out out, void (BoxScheme::*solve)(double*) const) const;

  const loss::Unknowns& _unknowns;
  const loop::Subspace& _image;
  const loss::Slice& _slice;
  core::Team* _team;
  int _unfoldings;
  loss::Linearization _linearization;
  std::vector<loss::Scalar> _scalars;  // of the unknowns, then the unfoldings
  std::vector<double> _slope_modes;    // of z'
  Eigen::MatrixXd _columns;            // projected derivatives of the field by all scalars but T
  std::unique_ptr<BoxScheme> _box;
  mutable std::vector<double> _modes, _other_modes, _nodal, _other_nodal;
  mutable Eigen::VectorXd _boxed;
};

}  // namespace orbweaver::equations
