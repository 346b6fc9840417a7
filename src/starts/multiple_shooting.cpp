#include "orbweaver/starts/multiple_shooting.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// By how much the motion turns in a piece between two states: errors grow by some e^4 there, and as many pieces as
/// that takes are few beside the steps of the integrator.
constexpr double turn_a_piece = 4.0;
/// Steps, and the least part of one: as `equations::approach` has them.
constexpr int most_newton_steps = 50;
constexpr double least_part = 1.0 / 256.0;

VectorXd as_vector(const std::vector<double>& z) {
  return Eigen::Map<const VectorXd>(z.data(), static_cast<Index>(z.size()));
}
std::vector<double> as_list(const VectorXd& z) { return {z.begin(), z.end()}; }

/// Times at which pieces begin, and the last one's end.
std::vector<double> pieces_of(const GuessCurve& curve) {
  std::vector<double> times{0.0};
  double turned = 0.0;
  for (std::size_t j = 1; j + 1 < curve.times.size(); ++j) {
    turned += (curve.times[j] - curve.times[j - 1]) * std::max(curve.rates[j], curve.rates[j - 1]);
    if (turned < turn_a_piece) continue;
    times.push_back(curve.times[j]);
    turned = 0.0;
  }
  times.push_back(curve.period);
  return times;
}

/// The states where pieces begin, one behind the other, and what each piece misses the next one's by. Where nothing is
/// conserved and nothing drives, an orbit has a period of its own: behind the states stands what all times are
/// multiplied by.
class Pieces {
 public:
  Pieces(const systems::System& system, const Integrator& integrator, const GuessCurve& curve)
      : _system(system),
        _integrator(integrator),
        _times(pieces_of(curve)),
        _d(system.dimension()),
        _has_own_period(!system.structure().conservative() && !system.structure().driven) {
    points = VectorXd::Ones(states() + (_has_own_period ? 1 : 0));
    for (Index n = 0; n < count(); ++n) points.segment(_d * n, _d) = as_vector(curve.state(_times[at(n)]));
    // Whole turns of angles over the period; what else it misses is to vanish.
    _turns = as_vector(curve.state(curve.period)) - points.head(_d);
    for (Index i = 0; i < _d; ++i)
      _turns(i) =
          system.structure().is_angle(at(i)) ? numerics::two_pi * std::round(_turns(i) / numerics::two_pi) : 0.0;
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(_times.size()) - 1; }
  [[nodiscard]] double time(Index n) const { return stretch(points) * _times[at(n)]; }
  [[nodiscard]] double length(const VectorXd& z, Index n) const {
    return stretch(z) * (_times[at(n + 1)] - _times[at(n)]);
  }
  [[nodiscard]] VectorXd begin(const VectorXd& z, Index n) const { return z.segment(_d * n, _d); }
  /// Where piece n is to end.
  [[nodiscard]] VectorXd end(const VectorXd& z, Index n) const {
    return n + 1 < count() ? begin(z, n + 1) : VectorXd(begin(z, 0) + _turns);
  }

  /// What the pieces from `z` miss; infinite where one cannot be followed.
  [[nodiscard]] VectorXd missed(const VectorXd& z) const {
    VectorXd out(states());
    try {
      if (!(stretch(z) > 0.0)) throw core::NumericalError("the period is not positive");
      for (Index n = 0; n < count(); ++n)
        out.segment(_d * n, _d) = as_vector(_integrator.advance(as_list(begin(z, n)), length(z, n))) - end(z, n);
    } catch (const core::NumericalError&) {
      out.setConstant(std::numeric_limits<double>::infinity());
    }
    return out;
  }

  /// The step of Newton's method, without a part along the motion. Where something is conserved one
  /// of an orbit's equations follows from the others: they are solved as least squares.
  [[nodiscard]] VectorXd step(const VectorXd& missed) const {
    MatrixXd equations = MatrixXd::Zero(states() + 1, points.size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    for (Index n = 0; n < count(); ++n) {
      const std::vector<double> transition = _integrator.transition(as_list(begin(points, n)), length(points, n));
      equations.block(_d * n, _d * n, _d, _d) += Eigen::Map<const RowMajor>(transition.data(), _d, _d);
      equations.block(_d * n, _d * ((n + 1) % count()), _d, _d) -= MatrixXd::Identity(_d, _d);
      if (_has_own_period)
        equations.block(_d * n, states(), _d, 1) = (_times[at(n + 1)] - _times[at(n)]) * slope(end(points, n));
    }
    VectorXd along(states());
    for (Index n = 0; n < count(); ++n) along.segment(_d * n, _d) = slope(begin(points, n));
    equations.row(states()).head(states()) = along.normalized().transpose();
    VectorXd right = VectorXd::Zero(states() + 1);
    right.head(states()) = -missed;
    return Eigen::ColPivHouseholderQR<MatrixXd>(equations).solve(right);
  }

  VectorXd points;

 private:
  [[nodiscard]] static std::size_t at(Index n) { return static_cast<std::size_t>(n); }
  [[nodiscard]] Index states() const { return _d * count(); }
  [[nodiscard]] double stretch(const VectorXd& z) const { return _has_own_period ? z(states()) : 1.0; }
  [[nodiscard]] VectorXd slope(const VectorXd& state) const {
    VectorXd out(_d);
    _system.field(1, state.data(), out.data());
    return out;
  }

  const systems::System& _system;
  const Integrator& _integrator;
  std::vector<double> _times;
  Index _d;
  bool _has_own_period;
  VectorXd _turns;
};

/// The pieces in one, each moved by what it misses, spread evenly over its time.
GuessCurve in_one(const systems::System& system, const Integrator& integrator, const Pieces& pieces, double longest) {
  const VectorXd& z = pieces.points;
  std::vector<TrajectoryNode> nodes;
  for (Index n = 0; n < pieces.count(); ++n) {
    const double length = pieces.length(z, n);
    std::vector<TrajectoryNode> piece =
        trajectory_nodes(system, integrator.advance, as_list(pieces.begin(z, n)), length, longest);
    const VectorXd rate = (as_vector(piece.back().state) - pieces.end(z, n)) / length;
    for (TrajectoryNode& node : piece) {
      for (std::size_t i = 0; i < node.state.size(); ++i) {
        node.state[i] -= node.time * rate(static_cast<Index>(i));
        node.slope[i] -= rate(static_cast<Index>(i));
      }
      node.time += pieces.time(n);
    }
    if (!nodes.empty()) nodes.pop_back();
    nodes.insert(nodes.end(), std::make_move_iterator(piece.begin()), std::make_move_iterator(piece.end()));
  }
  nodes.back().time = pieces.time(pieces.count());  // not by a sum, whose rounding would be the period's
  return curve_through(std::move(nodes));
}

}  // namespace

ShotCurve shot_through(const systems::System& system, const Integrator& integrator, const GuessCurve& curve,
                       double longest) {
  Pieces pieces(system, integrator, curve);
  VectorXd missed = pieces.missed(pieces.points);
  double part = 1.0;
  bool comes_nearer = missed.allFinite();
  for (int n = 0; n < most_newton_steps && comes_nearer; ++n) {
    core::interruption_point();
    const VectorXd step = pieces.step(missed);
    if (!step.allFinite()) break;
    comes_nearer = false;
    for (; part >= least_part && !comes_nearer; part *= 0.5) {
      const VectorXd points = pieces.points + part * step;
      const VectorXd there = pieces.missed(points);
      comes_nearer = there.norm() < (1.0 - 0.5 * part) * missed.norm();
      if (!comes_nearer) continue;
      pieces.points = points;
      missed = there;
    }
    part = std::min(1.0, 4.0 * part);  // the loop has halved it once more
  }
  Index worst = 0;
  missed.cwiseAbs().maxCoeff(&worst);
  ShotCurve out{in_one(system, integrator, pieces, longest), missed.norm(), 0.0};
  out.missed_at = pieces.time(worst / system.dimension());
  return out;
}

}  // namespace orbweaver::starts
