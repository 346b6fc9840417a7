#pragma once

#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/equations/preconditioned_equations.hpp"

namespace orbweaver::equations {

/// Newton's method with a preconditioner kept from an earlier point, accelerated: Anderson's mixing of the
/// preconditioned residuals (Anderson 1965; Walker and Ni 2011), which solves the linear part as GMRES would at one
/// residual and one back substitution an iteration. The factor is renewed where it does not contract well enough.
class AndersonSolver {
 public:
  /// What a caller leaves at its default is a property of the method, not of the problem.
  struct Options {
    double tolerance = 1e-12;  ///< on the estimated error of y, absolute
    double rounding = 3e-13;   ///< a change this small is as far as double precision goes
    int scaled_from = -1;      ///< changes of unknowns from here on (the borders) count `border_scale` times; -1: none
    double border_scale = 1.0;
    double stagnation = 1000.0;  ///< changes below this many tolerances that shrink no more are as far as digits go
    /// The same at the end of the iterations with a new factor: beside a narrow gap between families the preconditioner
    /// enlarges rounding so much in the direction across it.
    double stagnation_at_end = 1e6;
    double divergence = 5.0;     ///< a change this large is a failure: angles and momenta of an orbit are of order 1
    int stale_iterations = 10;   ///< with a kept factor; then it is renewed, which costs as much as some ten iterations
    int fresh_iterations = 18;   ///< with a new factor; then the solve has failed, unless changes still shrink,
    int slow_iterations = 60;    ///< which may go on for so many
    int most_iterations = 1000;  ///< over all factors: a bound from outside, which the two above do not reach
  };
  /// Called in each iteration with its number, from 0, and the size of the change: its largest entry, borders scaled.
  using Monitor = std::function<void(int iteration, double size)>;
  struct Result {
    bool converged = false;
    bool finite = true;
    bool stagnated = false;            ///< converged, as its changes shrink no more
    int iterations = 0;                ///< over all factors
    bool factored = false;             ///< the factor was renewed,
    std::vector<double> factor_point;  ///< here
    double first_change = 0.0;  ///< largest entry of the first preconditioned residual: the error of the prediction
    double last_change = 0.0;
  };

  /// Solves from the prediction in `u` (changed in place). `has_factor`: the preconditioner at hand is usable.
  [[nodiscard]] Result solve(PreconditionedEquations& equations, std::vector<double>& u, bool has_factor,
                             const Options& options, const Monitor& monitor = {});

 private:
  // Pairs that are mixed: as many as a solve with a kept factor has iterations, so that it forgets none.
  static constexpr int depth = 10;
  void resize(int size);
  void remember(int n);
  void mix(std::vector<double>& u);

  int _size = 0;
  int _count = 0;  // pairs remembered since the last start
  std::vector<double> _change, _last_change, _last_point, _prediction;
  std::vector<double> _point_differences, _change_differences;  // depth x size, a ring
  Eigen::Matrix<double, depth, depth> _gram;
};

}  // namespace orbweaver::equations
