#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "predictor.hpp"

namespace orbweaver::continuation {

/// A predicted and corrected point of a branch.
struct Trial {
  bool converged = false;       ///< the problem's equations are solved
  bool under_resolved = false;  ///< they are not, and more harmonics may help
  bool is_orbit = false;        ///< converged, and the loss over the whole loop is under its threshold
  bool unsolved = false;        ///< beside a fast motion: the loss where the equations ask is above threshold
  bool stagnated = false;       ///< the solver's changes shrank no more
  bool is_refused = false;      ///< it came to rest beside its equations, by GMRES too
  bool to_rounding = false;     ///< the loss between the places where the equations ask is no more than rounding leaves
  bool is_beside_the_way = false;  ///< its equations are not solved as far as the way asks, whatever the scene does
  bool truncated = false;       ///< its equations hold where they ask, and the loop does not obey them in between
  bool at_rounding = false;     ///< an orbit, though rounding keeps its loss above the threshold
  bool lost_in_rounding = false;  ///< it would be an orbit, but its speed is not known (corrector::largest_unknown)
  std::string reason;             ///< where it is no orbit
  std::vector<double> values;
  int order = 0;  ///< of the prediction
  int iterations = 0;
  double prediction_error = 0.0;  ///< of a coordinate, radians
  /// The last change of its solve, where the equations hold to rounding although the changes shrink no more: rounding
  /// leaves its place open by so much.
  double known_to = 0.0;
  double loss_rms = 0.0;
  double asked_rms = 0.0;  ///< the same where the equations ask
  double threshold = 0.0;
  double threshold_of_the_way = 0.0;  ///< that to which the equations are solved where the scene's tolerance is coarse
  double tolerance_met = 0.0;  ///< corrector::tolerance_met
  double amplitude = 0.0;      ///< rms distance from its mean, winding left out
  double size = 0.0;           ///< `extent_of` its rms size
  loop::Loop loop;             ///< set by `PointProblem::resolved`
};

/// Whether some angle turns over along a loop with these winding numbers: then it is no equilibrium.
[[nodiscard]] bool winds(const std::vector<double>& winding);
/// What tolerances and rounding are measured by, of a loop's rms distance from its mean or its rms size, winding left
/// out: a loop that winds is not small, however little the rest of it moves.
[[nodiscard]] double extent_of(const std::vector<double>& winding, double size);

/// What the last harmonics of a loop may weigh, by its rms distance from its mean, without winding, and `extent_of` its
/// rms size.
[[nodiscard]] double tail_limit(double amplitude, double size, const Options& options);

/// The orbits of one family near a base loop as points, vectors of numbers in which polynomials can run: how they are
/// corrected, measured and resolved. The scalars (T first) come last, from `scalars_at` on. What is kept from one
/// correction to the next lies in a ProblemState that the caller owns.
class PointProblem {
 public:
  virtual ~PointProblem() = default;
  PointProblem(const PointProblem&) = delete;
  PointProblem& operator=(const PointProblem&) = delete;

  [[nodiscard]] const Resolution& resolution() const { return _state.resolution; }
  /// The smallest resolution with harmonics up to `cutoff`, or a smaller one that has none beyond `largest`.
  [[nodiscard]] virtual Resolution resolution_for(int cutoff, const loop::TimeMap& map, int largest) const = 0;
  /// The next finer one under the same time map; none where it has harmonics beyond `largest`.
  [[nodiscard]] virtual std::optional<Resolution> next_resolution(int largest) const = 0;
  /// What `trial`, which needs more harmonics, is to be solved with; none beyond the options' largest cutoff.
  /// `settled` is the last point of the branch. A new time map may be fitted to it where `may_fit`.
  [[nodiscard]] virtual std::optional<Resolution> finer(const Trial& trial, const std::vector<double>& settled,
                                                        bool may_fit) = 0;
  /// The resolution to go on with after a trial was accepted whose loop is `loop` now; none to keep the present one.
  /// `may_fit` as for `finer`.
  [[nodiscard]] virtual std::optional<Resolution> coarser(const Trial& accepted, const loop::Loop& loop,
                                                          bool may_fit) = 0;
  /// Values at an earlier resolution to values at the present one.
  using Transfer = std::function<std::vector<double>(const std::vector<double>&)>;
  virtual Transfer resolve(const Resolution& to) = 0;
  /// After a change of the state from outside.
  virtual void state_replaced() {}
  /// Whether cells would have been preconditioned in another way in the last correction, had the state's
  /// `preconditioner` been the fitted box.
  [[nodiscard]] virtual bool can_fit_cells() { return false; }
  /// Whether the state's `preconditioner` takes part in corrections.
  [[nodiscard]] virtual bool is_preconditioned() const { return false; }

  [[nodiscard]] virtual std::vector<double> from_loop(const loop::Loop& loop) = 0;
  /// The change of a loop (without winding) as a change of a point; scalars stay.
  [[nodiscard]] virtual std::vector<double> from_change(const loop::Loop& change) = 0;
  /// A direction as the unit tangent of `at`, the loop of a point, which may be of an earlier resolution.
  [[nodiscard]] loop::Tangent tangent_of(const std::vector<double>& direction, const loop::Loop& at);
  /// The same of the length that the direction has.
  [[nodiscard]] virtual loop::Tangent change_of(const std::vector<double>& direction, const loop::Loop& at) = 0;
  [[nodiscard]] virtual std::size_t scalars_at() = 0;

  /// The inner product of the steps a - b and c - d in which the branch measures its parameter.
  [[nodiscard]] virtual double product(const std::vector<double>& a, const std::vector<double>& b,
                                       const std::vector<double>& c, const std::vector<double>& d) = 0;
  /// The inner product in which a change that the first of `conditions_at` allows is orthogonal to the prediction's
  /// direction.
  [[nodiscard]] virtual double condition_product(const std::vector<double>& a, const std::vector<double>& b,
                                                 const std::vector<double>& c, const std::vector<double>& d) {
    return product(a, b, c, d);
  }
  /// The archive's arclength between neighbours (see `arclength_between`).
  [[nodiscard]] virtual double distance(const std::vector<double>& a, const std::vector<double>& b) = 0;
  /// |dz(s = 0)| of a change of a point.
  [[nodiscard]] virtual double change_at_start(const std::vector<double>& change) = 0;
  /// True if the oscillation is that of `last` upside down: the step jumped across a fixed point, where the family ends
  /// (beyond it lie the same orbits half a period later).
  [[nodiscard]] virtual bool inverted(const Trial& trial, const std::vector<double>& last) = 0;
  /// Closed integral of p dq.
  [[nodiscard]] virtual double action(const Trial& trial) = 0;

  /// Takes out of a prediction and its direction what is no step along the family: the time shift since `last` (a
  /// phase that drifts from orbit to orbit would be extrapolated, and use up the steps), a period that is held, and
  /// unfoldings, which are 0 at an orbit.
  virtual void settle(Prediction& prediction, const std::vector<double>& last) = 0;
  /// The conditions to correct a prediction under, one row of the size of a point each: the change orthogonal to the
  /// branch first, then what the family holds, then the time shift where the symmetries do not hold the phase.
  [[nodiscard]] virtual std::vector<double> conditions_at(const Prediction& prediction) = 0;
  /// The same with the scalar of this number held instead of the place along the branch.
  [[nodiscard]] std::vector<double> conditions_with(const Prediction& prediction, int held_scalar);
  /// The point that solves the equations under these conditions, and has the energy that the family holds, if it does.
  [[nodiscard]] Trial correct(Prediction prediction, const std::vector<double>& conditions);
  /// False where a converged trial needs more harmonics. Sets `trial.loop`.
  [[nodiscard]] virtual bool resolved(Trial& trial) = 0;
  /// The family's direction at an orbit, on the side of `near.tangent`, which it is where the linear system is
  /// singular (next to a crossing). The course of the branch does not depend on who asks.
  [[nodiscard]] virtual std::vector<double> direction_at(const std::vector<double>& orbit, const Prediction& near) = 0;
  /// Two directions that span the surface of orbits at one of them: along `near.tangent` and not `near.across`, and the
  /// other way round. Throws MisuseError for problems of families, NumericalError where the linear system is singular.
  [[nodiscard]] virtual std::array<std::vector<double>, 2> surface_at(const std::vector<double>& orbit,
                                                                      const Prediction& near);

 protected:
  PointProblem(const systems::System& system, ProblemState& state) : _family(system), _state(state) {}
  [[nodiscard]] virtual Trial solve(Prediction prediction, const std::vector<double>& conditions) = 0;
  [[nodiscard]] ProblemState& state() { return _state; }

 private:
  const systems::System& _family;
  ProblemState& _state;
};

/// What a family is made of, besides the options.
struct FamilyOf {
  const systems::System& system;
  const loop::Loop& base;  ///< a loop of the family, or a fixed point as a constant loop
  const loop::Isotropy& isotropy;
  int places = 1;  ///< conditions that pick an orbit: 2 where the orbits are a surface
};

/// By collocation where it applies and the method is `automatic` or `collocation`, as whole loops otherwise. Throws
/// InputError where `collocation` is asked for and does not apply. All references must outlive the problem.
[[nodiscard]] std::unique_ptr<PointProblem> make_point_problem(const FamilyOf& family, const Options& options,
                                                               ProblemState& state);

}  // namespace orbweaver::continuation
