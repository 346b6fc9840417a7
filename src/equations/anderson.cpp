#include "orbweaver/equations/anderson.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::equations {

namespace {

using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

// Added to the unit diagonal of the normal equations: at the rounding of their entries, so that pairs that depend on
// each other get some weights and none that are huge.
constexpr double regularisation = 1e-14;
// Keeps the scale of a pair without any change finite.
constexpr double least_square = 1e-300;

// The estimated error after a change is that change times the rate of contraction, times this for safety; one lucky
// iteration is not believed to contract by more than `least_rate`.
constexpr double safety = 5.0;
constexpr double least_rate = 0.05;
// A change at rounding ends a solve only after so many iterations with one factor: the first ones may be small by
// chance.
constexpr int before_rounding = 3;
// Stagnant: after so many iterations with one factor none of the last four shrank below this part of the first of them.
constexpr int before_stagnation = 8;
constexpr int watched = 4;
constexpr double shrinks = 0.3;

}  // namespace

void AndersonSolver::resize(int size) {
  if (size == _size) return;
  _size = size;
  const auto n = static_cast<std::size_t>(size);
  for (std::vector<double>* v : {&_change, &_last_change, &_last_point, &_prediction}) v->resize(n);
  _point_differences.resize(depth * n);
  _change_differences.resize(depth * n);
}

/// Adds the pair (point, change) minus the one before to the ring, and its products to the Gram matrix.
void AndersonSolver::remember(int slot) {
  const int used = std::min(_count, depth);
  const ConstVectorMap added(_change_differences.data() + slot * _size, _size);
  for (int n = 0; n < used; ++n) {
    const double product = added.dot(ConstVectorMap(_change_differences.data() + n * _size, _size));
    _gram(slot, n) = _gram(n, slot) = product;
  }
}

/// u <- the combination of remembered points whose combined change is least, moved by that change.
void AndersonSolver::mix(std::vector<double>& u) {
  const int used = std::min(_count, depth);
  VectorMap point(u.data(), _size);
  const ConstVectorMap change(_last_change.data(), _size);
  if (used > 0) {
    // Normal equations, scaled to a unit diagonal and slightly regularised: pairs may depend on each other.
    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, depth, depth>;
    using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, depth, 1>;
    const SmallVector scale = (_gram.diagonal().head(used).array() + least_square).sqrt().inverse();
    Small matrix = scale.asDiagonal() * _gram.topLeftCorner(used, used) * scale.asDiagonal();
    matrix.diagonal().array() += regularisation;
    SmallVector side(used);
    for (int a = 0; a < used; ++a)
      side(a) = scale(a) * ConstVectorMap(_change_differences.data() + a * _size, _size).dot(change);
    const SmallVector y = matrix.ldlt().solve(side);
    for (int a = 0; a < used; ++a)
      point -= (y(a) * scale(a)) * (ConstVectorMap(_point_differences.data() + a * _size, _size) -
                                    ConstVectorMap(_change_differences.data() + a * _size, _size));
  }
  point -= change;
}

AndersonSolver::Result AndersonSolver::solve(PreconditionedEquations& equations, std::vector<double>& u,
                                             bool has_factor, const Options& options, const Monitor& monitor) {
  resize(equations.size());
  _count = 0;
  _prediction = u;
  Result result;
  VectorMap change(_change.data(), _size);
  if (!has_factor) {
    equations.factor(u.data());
    result.factor_point = u;
    result.factored = true;
  }
  int since_factor = 0;
  double recent[watched] = {};  // the last sizes, a ring
  for (;; ++since_factor) {
    core::interruption_point();
    equations.residual(u.data(), _change.data());
    equations.precondition(_change.data());
    ++result.iterations;
    const Eigen::Index borders = options.scaled_from < 0 ? 0 : _size - options.scaled_from;
    const double size =
        std::max(change.head(_size - borders).lpNorm<Eigen::Infinity>(),
                 borders == 0 ? 0.0 : options.border_scale * change.tail(borders).lpNorm<Eigen::Infinity>());
    if (result.iterations == 1 || !std::isfinite(result.first_change)) result.first_change = size;
    if (monitor) monitor(result.iterations - 1, size);
    if (!change.allFinite()) {
      result.finite = false;
      if (result.factored) return result;
    } else {
      result.finite = true;
    }
    const bool diverged = !result.finite || !(size < options.divergence);
    if (!diverged && since_factor > 0) {
      const double rate = std::clamp(size / result.last_change, least_rate, 1.0);
      if (safety * rate * size < options.tolerance || (since_factor > before_rounding && size < options.rounding)) {
        VectorMap(u.data(), _size) -= change;
        result.last_change = size;
        result.converged = true;
        return result;
      }
    }
    // As far as the digits go: the changes are small and shrink no more. What they leave is the loss's to judge.
    recent[since_factor % watched] = size;
    const double least = *std::min_element(recent, recent + watched);
    const bool shrinks_no_more =
        since_factor >= before_stagnation && least > shrinks * recent[(since_factor + 1) % watched];
    const bool at_end =
        result.factored && since_factor > (shrinks_no_more ? options.fresh_iterations : options.slow_iterations);
    const double near = (at_end ? options.stagnation_at_end : options.stagnation) * options.tolerance;
    const bool stagnant = shrinks_no_more && size < near;
    if (stagnant) {
      result.stagnated = true;
      result.last_change = size;
      result.converged = true;
      return result;
    }
    if (result.iterations >= options.most_iterations) {
      result.last_change = size;
      return result;
    }
    if (diverged || at_end || (!result.factored && since_factor > options.stale_iterations)) {
      if (diverged) result.last_change = size;
      if (result.factored) return result;
      if (diverged) u = _prediction;
      equations.factor(u.data());
      result.factor_point = u;
      result.factored = true;
      since_factor = -1;
      _count = 0;
      continue;
    }
    if (since_factor > 0) {
      const int slot = _count % depth;
      VectorMap(_change_differences.data() + slot * _size, _size) = change - VectorMap(_last_change.data(), _size);
      VectorMap(_point_differences.data() + slot * _size, _size) =
          VectorMap(u.data(), _size) - VectorMap(_last_point.data(), _size);
      ++_count;
      remember(slot);
    }
    _last_change.swap(_change);
    new (&change) VectorMap(_change.data(), _size);
    _last_point = u;
    result.last_change = size;
    mix(u);
  }
}

}  // namespace orbweaver::equations
