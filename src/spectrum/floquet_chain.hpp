#pragma once

#include <vector>

#include <Eigen/Dense>

#include "floquet_group.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"
#include "variational_step.hpp"

namespace orbweaver::spectrum {

/// The linearised flow along T/p of an orbit, cut into segments t_m .. t_(m+1), m = 0 .. segments - 1, equal in s.
struct Chain {
  Eigen::VectorXd steps;        ///< lengths t_(m+1) - t_m
  Eigen::MatrixXd states;       ///< dimension x (segments + 1)
  Eigen::MatrixXd fields;       ///< f there
  Eigen::MatrixXd gradients;    ///< of the energy there; empty where there is none
  Eigen::MatrixXd jacobians;    ///< f_z there (matrix_table.hpp)
  Eigen::MatrixXd transitions;  ///< from t_m to t_(m+1), one end on the loop (matrix_table.hpp)
  Eigen::MatrixXd truncations;  ///< estimates of their truncation errors (matrix_table.hpp)
  double truncation_share = 0.1;  ///< truncation errors as a share of their estimates
  Eigen::MatrixXd defects;      ///< dimension x segments: state reached from t_m minus the loop's at t_(m+1)
  std::vector<bool> mirrored;   ///< given by the reversor: the segment ends on the loop and starts off it
  Eigen::MatrixXd offsets;      ///< dimension x segments: how far off the loop it ends, or starts where mirrored
  // At points that divide each long segment equally, segment by segment; empty where segments are short.
  Eigen::MatrixXd inner_fields;
  Eigen::MatrixXd inner_gradients;
  Eigen::MatrixXd inner_transitions;  ///< from t_m to them (matrix_table.hpp)

  [[nodiscard]] Eigen::Index segments() const { return states.cols() - 1; }
  [[nodiscard]] Eigen::Index dimension() const { return states.rows(); }
};

/// The least allowed number of segments >= `at_least`. Few are used, so that few Fourier plans are made: multiples of
/// `multiple`, by 2 to 7, or by 8, 9, 10, 12, 14 or 15 times a power of 2. With the prime factors 11 and 13 the plans
/// would not be among those that are known.
[[nodiscard]] int allowed_segments(double at_least, int multiple);
/// Lengths of the first `segments` of `around` segments a period, equal in s.
[[nodiscard]] Eigen::VectorXd steps_of(const loop::Loop& loop, int segments, int around);
/// Throws core::NotFiniteError unless what was made of the rates of the linearised flow is finite.
void require_finite_rates(double value);
/// Likewise of what was made of the field itself.
void require_finite_field(double value);

/// f, its Jacobian and the energy's gradient at the chain's states.
void evaluate_field(const systems::System& system, Chain& chain);
/// The energy's gradient alone, if there is one.
void evaluate_gradients(const systems::System& system, Chain& chain);
/// The Jacobians alone.
void evaluate_jacobians(const systems::System& system, Chain& chain);

/// The chain with at least `at_least` segments a period: as many as suit the loop's resolution, the rates of its
/// linearised flow and its symmetries, even on T/p. Segments that a reversor gives are not integrated. A team divides
/// the segments among its members, who all get the whole chain. Throws core::NotFiniteError if the Jacobian is not
/// finite on the loop.
[[nodiscard]] Chain make_chain(const systems::System& system, VariationalStep& stepper, const loop::Loop& loop,
                               const FundamentalGroup& group, int at_least, core::Team* team = nullptr);

}  // namespace orbweaver::spectrum
