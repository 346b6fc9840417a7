#include "orbweaver/starts/multiple_shooting.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/anderson.hpp"
#include "orbweaver/equations/damped_newton.hpp"
#include "orbweaver/equations/preconditioned_equations.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using State = std::vector<double>;

/// By how much the motion turns in a piece outside of close passages: errors grow by some e^4 there.
constexpr double turn_a_piece = 4.0;
/// Of the states, in parts of the integrator's: what a piece of several steps leaves.
constexpr double of_integrator = 10.0;

VectorXd as_vector(const State& z) { return Eigen::Map<const VectorXd>(z.data(), static_cast<Index>(z.size())); }
std::size_t at(Index n) { return static_cast<std::size_t>(n); }

/// The rate below which the motion is for half of the time.
double usual_rate(const GuessCurve& curve) {
  std::vector<std::size_t> cells(curve.times.size() - 1);
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  std::sort(cells.begin(), cells.end(), [&](std::size_t a, std::size_t b) { return curve.rates[a] < curve.rates[b]; });
  double time = 0.0;
  for (const std::size_t j : cells)
    if ((time += curve.times[j + 1] - curve.times[j]) >= 0.5 * curve.period) return curve.rates[j];
  return curve.rates[cells.back()];
}

/// Times at which pieces begin, the slowest ones of equal parts of the period, and the last piece's end.
std::vector<double> pieces_of(const GuessCurve& curve) {
  const auto parts = static_cast<std::size_t>(std::ceil(curve.period * usual_rate(curve) / turn_a_piece));
  std::vector<double> times;
  std::size_t j = 0;
  for (std::size_t n = 1; n <= std::max<std::size_t>(parts, 1); ++n) {
    const double end = n < parts ? curve.period * static_cast<double>(n) / static_cast<double>(parts) : curve.period;
    std::size_t slowest = j;
    for (; curve.times[j] < end; ++j)
      if (curve.rates[j] < curve.rates[slowest]) slowest = j;
    if (times.empty() || curve.times[slowest] > times.back()) times.push_back(curve.times[slowest]);
  }
  times.push_back(times.front() + curve.period);
  return times;
}

/// The unknowns are the states where pieces begin, one behind the other, and what all times are multiplied by, which is
/// free where nothing is conserved. The equations: each piece ends where the next one begins, and the states are not
/// moved along the motion.
class Pieces final : public equations::PreconditionedEquations {
 public:
  Pieces(const systems::System& system, const Integrator& integrator, const GuessCurve& curve)
      : times(pieces_of(curve)), _system(system), _integrator(integrator), _d(system.dimension()) {
    for (Index n = 0; n < count(); ++n) {
      const State state = curve.state(times[at(n)]);
      guess.insert(guess.end(), state.begin(), state.end());
    }
    guess.push_back(1.0);
    _turns = as_vector(curve.state(curve.period)) - as_vector(curve.state(0.0));
    for (Index i = 0; i < _d; ++i)
      _turns(i) =
          system.structure().is_angle(at(i)) ? numerics::two_pi * std::round(_turns(i) / numerics::two_pi) : 0.0;
    _along = VectorXd::Zero(size());
    for (Index n = 0; n < count(); ++n) _along.segment(_d * n, _d) = slope(guess.data() + _d * n);
    _along.normalize();
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(times.size()) - 1; }
  [[nodiscard]] int size() const override { return static_cast<int>(_d * count()) + 1; }
  [[nodiscard]] double stretch(const double* u) const { return u[_d * count()]; }
  [[nodiscard]] double length(const double* u, Index n) const { return stretch(u) * (times[at(n + 1)] - times[at(n)]); }
  [[nodiscard]] State begin(const double* u, Index n) const { return {u + _d * n, u + _d * (n + 1)}; }

  /// Not finite where a piece cannot be followed.
  void residual(const double* u, double* r) const override {
    const Eigen::Map<const VectorXd> point(u, size());
    Eigen::Map<VectorXd> out(r, size());
    try {
      for (Index n = 0; n < count(); ++n) {
        out.segment(_d * n, _d) =
            as_vector(_integrator.advance(begin(u, n), length(u, n))) - point.segment(_d * ((n + 1) % count()), _d);
        if (n + 1 == count()) out.segment(_d * n, _d) -= _turns;
      }
      out(size() - 1) = _along.dot(point - as_vector(guess));
    } catch (const core::NumericalError&) {
      out.setConstant(std::numeric_limits<double>::infinity());
    }
  }

  /// Where something is conserved one of the equations follows from the others: they are solved as least squares.
  void factor(const double* u) override {
    MatrixXd matrix = MatrixXd::Zero(size(), size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    for (Index n = 0; n < count(); ++n) {
      const State transition = _integrator.transition(begin(u, n), length(u, n));
      matrix.block(_d * n, _d * n, _d, _d) += Eigen::Map<const RowMajor>(transition.data(), _d, _d);
      matrix.block(_d * n, _d * ((n + 1) % count()), _d, _d) -= MatrixXd::Identity(_d, _d);
      if (!_system.structure().conservative())
        matrix.block(_d * n, size() - 1, _d, 1) =
            (times[at(n + 1)] - times[at(n)]) * slope(_integrator.advance(begin(u, n), length(u, n)).data());
    }
    matrix.row(size() - 1) = _along.transpose();
    _factor.compute(matrix);
  }

  void precondition(double* r) const override {
    Eigen::Map<VectorXd> values(r, size());
    values = _factor.solve(values).eval();
  }

  const std::vector<double> times;
  State guess;

 private:
  [[nodiscard]] VectorXd slope(const double* state) const {
    VectorXd out(_d);
    _system.field(1, state, out.data());
    return out;
  }

  const systems::System& _system;
  const Integrator& _integrator;
  Index _d;
  VectorXd _turns;  ///< of angles over the period
  VectorXd _along;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> _factor;
};

/// The trajectories of the pieces, one behind the other.
GuessCurve in_one(const systems::System& system, const Integrator& integrator, const Pieces& pieces, const double* u,
                  double period, double longest) {
  std::vector<TrajectoryNode> nodes;
  for (Index n = 0; n < pieces.count(); ++n) {
    std::vector<TrajectoryNode> piece =
        trajectory_nodes(system, integrator.advance, pieces.begin(u, n), pieces.length(u, n), longest);
    const double from = pieces.stretch(u) * (pieces.times[at(n)] - pieces.times.front());
    for (TrajectoryNode& node : piece) node.time += from;
    if (!nodes.empty()) nodes.pop_back();
    nodes.insert(nodes.end(), std::make_move_iterator(piece.begin()), std::make_move_iterator(piece.end()));
  }
  nodes.back().time = pieces.stretch(u) * period;  // not by a sum, whose rounding would be the period's
  return curve_through(std::move(nodes));
}

}  // namespace

ShotCurve shot_through(const systems::System& system, const Integrator& integrator, const GuessCurve& curve,
                       double longest) {
  Pieces pieces(system, integrator, curve);
  std::vector<double> u = pieces.guess;
  ShotCurve out;
  try {
    equations::approach(pieces, u, pieces.size() - 1, 1.0);
    equations::AndersonSolver::Options options;
    options.tolerance = of_integrator * integrator.tolerance;
    if (equations::AndersonSolver().solve(pieces, u, false, options).converged)
      out.curve = in_one(system, integrator, pieces, u.data(), curve.period, longest);
  } catch (const core::NumericalError&) {  // a piece cannot be followed: what it misses is not finite
  }
  VectorXd missed(pieces.size());
  pieces.residual(u.data(), missed.data());
  Index worst = 0;
  out.missed = missed.head(pieces.size() - 1).cwiseAbs().maxCoeff(&worst);
  out.missed_at = std::fmod(pieces.times[at(worst / system.dimension() + 1)], curve.period);
  return out;
}

}  // namespace orbweaver::starts
