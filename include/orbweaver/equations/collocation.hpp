#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "orbweaver/equations/preconditioned_equations.hpp"
#include "orbweaver/equations/preconditioner.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/grid/staggered_grid.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::equations {

class BoxScheme;
class DenseFactor;
class ShellGmres;

/// The bordered equations of an orbit on a fundamental domain, and their preconditioner (docs/mathematics.md,
/// "Collocation on the fundamental domain"):
///
///   y_(j+1) - y_j + n h - c_j (f(z_j; p) + sum_k mu_k grad H_k(z_j)) = 0 at the midpoints, c_j = h T density / (2 pi),
///   end conditions of the domain,   weights_q . (u - reference) = 0 for each border.
///
/// A point u holds y at the nodes (dimension x stride), then the scalars: T, parameters p, unfoldings mu (zero at an
/// orbit). There is a border, and a condition, for each.
class Collocation final : public PreconditionedEquations {
 public:
  /// The scalars of the system's families: T, the parameters that move along them, and an unfolding of the energy where
  /// there is one and no reversor fixes the phase.
  [[nodiscard]] static std::vector<loss::Scalar> scalars_of_families(const systems::System& system,
                                                                     const loop::FundamentalDomain& domain);
  /// Conditions that pick one orbit: the place along the family, what the family holds, and the phase where no reversor
  /// fixes it.
  [[nodiscard]] static int conditions_of_families(const systems::System& system, const loop::FundamentalDomain& domain);
  /// True where there are as many of both, and of end conditions as coordinates. Any dimension: nothing
  /// of this is divided by a team, and need not be. Five orbits of a chain of oscillators take one rank 0.8, 1.2, 12
  /// and 66 ms (d = 8, 16, 32, 64); as loops they take one rank 5.6, 16, 80 and 471 ms, and a team of two 5.5, 15, 58
  /// and 316 ms.
  /// `places`: how many conditions pick an orbit among all, 1 on a family and 2 on a surface of orbits.
  [[nodiscard]] static bool applies(const systems::System& system, const loop::FundamentalDomain& domain,
                                    int places = 1);

  /// `centre`: a point that the symmetries of the domain map to itself, to which y is relative; `winding` as in Loop;
  /// `scalars` begin with T, then those that loops carry, and without any are those of the system's families.
  Collocation(const systems::System& system, const loop::FundamentalDomain& domain, std::vector<double> centre,
              std::vector<double> winding, int cells, const loop::TimeMap& map, std::vector<loss::Scalar> scalars = {});
  ~Collocation() override;
  Collocation(const Collocation&) = delete;
  Collocation& operator=(const Collocation&) = delete;

  [[nodiscard]] const systems::System& system() const { return _system; }
  [[nodiscard]] int dimension() const { return _system.dimension(); }
  [[nodiscard]] int cells() const { return _grid.cells(); }
  [[nodiscard]] const loop::StaggeredGrid& grid() const { return _grid; }
  [[nodiscard]] const loop::TimeMap& time_map() const { return _map; }
  [[nodiscard]] const std::vector<loss::Scalar>& scalars() const { return _scalars; }
  [[nodiscard]] int borders() const { return static_cast<int>(_scalars.size()); }
  /// Numbers in a point.
  [[nodiscard]] int size() const override { return dimension() * _grid.stride() + borders(); }
  [[nodiscard]] int period_at() const { return dimension() * _grid.stride(); }

  /// One row of `weights` (borders x size) a border.
  void set_conditions(std::span<const double> weights, std::span<const double> reference);
  /// The left-hand sides at `u`, laid out like a point (end condition i at node `cells` of coordinate i).
  void residual(const double* u, double* r) const override;
  /// Builds the preconditioner at `u` under the present conditions.
  void factor(const double* u) override;
  /// Throws NotFiniteError where the field or its Jacobian at `u` is not finite where these equations or their quality
  /// ask for them.
  void check_field(const double* u) const;
  /// From the next factor on; at first it is the plain box scheme.
  void precondition_by(Preconditioner preconditioner) { _preconditioner = preconditioner; }
  /// Whether the fitted box differs from the plain one in any cell, as of where the preconditioner was last built.
  [[nodiscard]] bool has_cells_to_fit() const;
  void precondition(double* r) const override;
  /// Whether the last `precondition` solved the derivative's equations: the boxes stand for it only, and GMRES goes no
  /// further than it comes.
  [[nodiscard]] bool is_solved() const;
  /// What rounding leaves of the residual at `u`, near where the preconditioner was built, as a norm: that of the
  /// values at the nodes, and of the states, as sums of these, as the field multiplies it.
  [[nodiscard]] double residual_rounding(const double* u) const;
  /// Whether that explains the residual: where not, a solver that came to rest at `u` did so beside the solution, along
  /// some direction in which the equations are so flat that the box scheme's own error is all that is seen of it.
  [[nodiscard]] bool is_at_rounding(const double* u) const;
  /// The derivative of `residual` where the preconditioner was built, applied to a perturbation of the point.
  void apply_jacobian(const double* v, double* r) const;

  /// Means over time, each as a square root.
  struct Quality {
    double loss_rms = 0.0;   ///< of |dz/dt - f|^2, on twice the nodes of the loop
    double asked = 0.0;      ///< the same in the middles of the cells, where the equations ask for 0,
    double unasked = 0.0;    ///< and at the nodes between them, where truncation shows
    double speed_rms = 0.0;  ///< of |f|^2
    double amplitude = 0.0;  ///< of |z - mean z|^2, winding left out
    double size = 0.0;       ///< of |z|^2, winding left out
  };
  [[nodiscard]] Quality quality(const double* u) const;
  /// sqrt of the mean of |df/dz|^2 where the preconditioner was built.
  [[nodiscard]] double field_jacobian_rms() const { return _jacobian_rms; }
  /// Closed integral of p dq.
  [[nodiscard]] double action(const double* u) const;

  [[nodiscard]] loop::Loop to_loop(const double* u) const;
  /// The point of a loop that has this grid's time map and symmetries.
  void from_loop(const loop::Loop& loop, double* u) const;
  /// sqrt(mean over time of |z_a - z_b|^2 + ((T_a - T_b) / T_b)^2 + |p_a - p_b|^2), p the parameters that move along
  /// families: the archive's arclength between neighbours.
  [[nodiscard]] double distance(const double* a, const double* b) const;
  /// Projects a point, or a difference of points, on the states that the equivariances of shift 0 keep: extrapolation
  /// multiplies what rounding has left beside them, and no correction sees it.
  void keep_symmetries(double* u) const;
  /// The same orbit on another grid or under another time map.
  [[nodiscard]] std::vector<double> resampled(const Collocation& from, const std::vector<double>& u) const;
  /// False where the symmetries make the coordinate's mean over the loop zero (relative to the centre).
  [[nodiscard]] bool keeps_mean(int coordinate) const;
  /// Weights of the nodes in a mean over the loop (stride numbers, of sum 1).
  [[nodiscard]] const std::vector<double>& node_weights() const { return _node_weights; }
  [[nodiscard]] const std::vector<double>& centre() const { return _centre; }
  [[nodiscard]] const std::vector<double>& winding() const { return _winding; }

 private:
  void midpoint_states(const double* u) const;
  void node_states(const double* u) const;
  void factor_box(const double* blocks);
  void factor_jacobian();
  void begin_gmres(const double* u);
  void solve_linearised(double* r) const;
  /// The system with the parameters of `u`.
  [[nodiscard]] const systems::System& system_at(const double* u) const;
  /// df/ds at the midpoints for a scalar s other than T, into _gradient.
  void derivatives_by(const systems::System& system, const loss::Scalar& scalar) const;

  const systems::System& _system;
  const loop::StaggeredGrid& _grid;
  loop::TimeMap _map;
  std::vector<double> _centre;
  std::vector<double> _winding;
  std::vector<loss::Scalar> _scalars;
  std::vector<double> _density;  // at the midpoints
  std::vector<double> _node_density;
  std::vector<double> _node_weights;
  std::vector<bool> _keeps_mean;
  loop::FundamentalDomain::Ends _ends;
  std::optional<Eigen::MatrixXd> _projection;  // of the domain
  std::vector<double> _weights;
  std::vector<double> _reference;
  std::unique_ptr<BoxScheme> _box;
  std::unique_ptr<DenseFactor> _exact;  // in place of it
  std::unique_ptr<ShellGmres> _gmres;   // around it
  double _rounding = 0.0;               // of the residual, where GMRES was begun
  mutable bool _is_reached = false;     // by what GMRES solved last
  Preconditioner _preconditioner = Preconditioner::box;
  double _jacobian_rms = 0.0;
  mutable std::shared_ptr<const systems::System> _moved;  // with the parameters of the last point, where any moves
  mutable std::vector<double> _z, _f, _gradient, _blocks, _columns, _nodal, _slope, _node_field, _difference;
};

}  // namespace orbweaver::equations
