#include "objective.hpp"

#include <cmath>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::corrector {

loop::Loop Objective::loop_at(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd u = _slice.expand(x);
  return _unknowns.moved(_base, std::span<const double>(u.data(), static_cast<std::size_t>(u.size())));
}

std::shared_ptr<const systems::System> Objective::system_at(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd u = _slice.expand(x);
  return _unknowns.moved(_system, std::span<const double>(u.data(), static_cast<std::size_t>(u.size())));
}

bool Objective::defined_at(const Eigen::VectorXd& x) const {
  if (!x.allFinite()) return false;
  const double period = loop_at(x).period;
  return std::isfinite(period) && period > 0.0;
}

const loss::Linearization& Objective::at(const Eigen::VectorXd& x) {
  core::interruption_point();
  if (!_linearization || _point.size() != x.size() || _point != x) {
    _linearization.reset();
    _linearization = std::make_unique<loss::Linearization>(*system_at(x), loop_at(x), _order, _unknowns.scalars);
    _point = x;
  }
  return *_linearization;
}

Eigen::VectorXd Objective::gradient(const Eigen::VectorXd& x) {
  const std::vector<double> g = at(x).gradient(_unknowns);
  return _slice.reduce(loss::ConstVectorMap(g.data(), static_cast<Eigen::Index>(g.size())));
}

void Objective::hessian(const Eigen::VectorXd& x, loss::Curvature curvature, const core::Handle<Mat>& out) {
  _slice.reduce_symmetric(loss::assemble_hessian(at(x), _unknowns, curvature), out);
}

core::Handle<Mat> Objective::jacobian(const Eigen::VectorXd& x) {
  return _slice.reduce_columns(loss::assemble_jacobian(at(x), _unknowns));
}

int Objective::rows() const { return _base.dimension * loop::nodes_for(_base); }

}  // namespace orbweaver::corrector
