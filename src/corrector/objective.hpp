#pragma once

#include <memory>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::corrector {

/// The loss as a function of the free coordinates x of a slice; the last linearization is kept, since solvers ask for
/// value, gradient and Hessian of the same point.
class Objective {
 public:
  Objective(const systems::System& system, const loop::Loop& base, const loss::Unknowns& unknowns,
            const loss::Slice& slice, loss::Linearization::Order order)
      : _system(system), _base(base), _unknowns(unknowns), _slice(slice), _order(order) {}

  [[nodiscard]] loop::Loop loop_at(const Eigen::VectorXd& x) const;
  [[nodiscard]] std::shared_ptr<const systems::System> system_at(const Eigen::VectorXd& x) const;
  /// False where the loop is not finite or its period not positive, so that nothing can be evaluated.
  [[nodiscard]] bool defined_at(const Eigen::VectorXd& x) const;
  [[nodiscard]] const loss::Linearization& at(const Eigen::VectorXd& x);
  [[nodiscard]] Eigen::VectorXd gradient(const Eigen::VectorXd& x);
  /// The Hessian on the slice into `out` (free x free).
  void hessian(const Eigen::VectorXd& x, loss::Curvature curvature, const core::Handle<Mat>& out);
  [[nodiscard]] core::Handle<Mat> jacobian(const Eigen::VectorXd& x);

  [[nodiscard]] const loss::Slice& slice() const { return _slice; }
  [[nodiscard]] const loss::Unknowns& unknowns() const { return _unknowns; }
  [[nodiscard]] int rows() const;

 private:
  const systems::System& _system;
  const loop::Loop& _base;
  const loss::Unknowns& _unknowns;
  const loss::Slice& _slice;
  loss::Linearization::Order _order;
  Eigen::VectorXd _point;
  std::unique_ptr<loss::Linearization> _linearization;
};

}  // namespace orbweaver::corrector
