#pragma once

#include <vector>

#include <Eigen/Dense>

#include "floquet_group.hpp"
#include "orbweaver/loop/loop.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// The linearised flow along T/p of an orbit, cut into equal segments t_m = m h, m = 0 .. segments.
struct Chain {
  double step = 0.0;                         ///< h
  Eigen::MatrixXd states;                    ///< dimension x (segments + 1)
  Eigen::MatrixXd fields;                    ///< f there
  std::vector<Eigen::MatrixXd> jacobians;    ///< f_z there
  std::vector<Eigen::MatrixXd> transitions;  ///< from t_m to t_(m+1), from the loop's own state at t_m
  Eigen::MatrixXd defects;                   ///< dimension x segments: state reached minus the loop's
  std::vector<double> truncation;            ///< relative error of each transition matrix, estimated

  [[nodiscard]] int segments() const { return static_cast<int>(transitions.size()); }
};

/// Steps are halved until the truncation errors together are below the tolerance or the refinements are used up.
[[nodiscard]] Chain make_chain(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                               const FloquetOptions& options);

}  // namespace orbweaver::spectrum
