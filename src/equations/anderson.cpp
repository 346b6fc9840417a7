#include "orbweaver/equations/anderson.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace orbweaver::equations {

namespace {

using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

void AndersonSolver::resize(int size) {
  if (size == _size) return;
  _size = size;
  const auto n = static_cast<std::size_t>(size);
  for (std::vector<double>* v : {&_change, &_last_change, &_last_point, &_prediction}) v->assign(n, 0.0);
  _point_differences.assign(depth * n, 0.0);
  _change_differences.assign(depth * n, 0.0);
}

/// Adds the pair (point, change) minus the one before to the ring, and its products to the Gram matrix.
void AndersonSolver::remember(int slot) {
  const int used = std::min(_count, depth);
  const ConstVectorMap added(_change_differences.data() + slot * _size, _size);
  for (int n = 0; n < used; ++n) {
    const double product = added.dot(ConstVectorMap(_change_differences.data() + n * _size, _size));
    _gram[slot][n] = _gram[n][slot] = product;
  }
}

/// u <- the combination of remembered points whose combined change is least, moved by that change.
void AndersonSolver::mix(std::vector<double>& u) {
  const int used = std::min(_count, depth);
  VectorMap point(u.data(), _size);
  const ConstVectorMap change(_last_change.data(), _size);
  if (used > 0) {
    // Normal equations, scaled to a unit diagonal and slightly regularised.
    double scale[depth];
    double matrix[depth][depth];
    double y[depth];
    for (int a = 0; a < used; ++a) scale[a] = 1.0 / std::sqrt(_gram[a][a] + 1e-300);
    for (int a = 0; a < used; ++a) {
      y[a] = scale[a] * ConstVectorMap(_change_differences.data() + a * _size, _size).dot(change);
      for (int b = 0; b <= a; ++b) matrix[a][b] = scale[a] * scale[b] * _gram[a][b];
      matrix[a][a] += 1e-14;
    }
    for (int a = 0; a < used; ++a)
      for (int b = 0; b <= a; ++b) {
        double sum = matrix[a][b];
        for (int c = 0; c < b; ++c) sum -= matrix[a][c] * matrix[b][c];
        matrix[a][b] = a == b ? std::sqrt(std::max(sum, 1e-16)) : sum / matrix[b][b];
      }
    for (int a = 0; a < used; ++a) {
      for (int c = 0; c < a; ++c) y[a] -= matrix[a][c] * y[c];
      y[a] /= matrix[a][a];
    }
    for (int a = used - 1; a >= 0; --a) {
      for (int c = a + 1; c < used; ++c) y[a] -= matrix[c][a] * y[c];
      y[a] /= matrix[a][a];
    }
    for (int a = 0; a < used; ++a)
      point -= (y[a] * scale[a]) * (ConstVectorMap(_point_differences.data() + a * _size, _size) -
                                    ConstVectorMap(_change_differences.data() + a * _size, _size));
  }
  point -= change;
}

AndersonSolver::Result AndersonSolver::solve(PreconditionedEquations& equations, std::vector<double>& u,
                                             bool has_factor, const Options& options) {
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
  double recent[4] = {};  // the last sizes, a ring
  for (;; ++since_factor) {
    equations.residual(u.data(), _change.data());
    equations.precondition(_change.data());
    ++result.iterations;
    const Eigen::Index borders = options.scaled_from < 0 ? 0 : _size - options.scaled_from;
    const double size =
        std::max(change.head(_size - borders).lpNorm<Eigen::Infinity>(),
                 borders == 0 ? 0.0 : options.border_scale * change.tail(borders).lpNorm<Eigen::Infinity>());
    if (result.iterations == 1) result.first_change = size;
    if (!change.allFinite()) {
      result.finite = false;
      if (result.factored) return result;
    } else {
      result.finite = true;
    }
    const bool diverged = !result.finite || !(size < options.divergence);
    if (!diverged && since_factor > 0) {
      const double rate = std::clamp(size / result.last_change, 0.05, 1.0);
      if (5.0 * rate * size < options.tolerance || (since_factor > 3 && size < options.rounding)) {
        VectorMap(u.data(), _size) -= change;
        result.last_change = size;
        result.converged = true;
        return result;
      }
    }
    // As far as the digits go: the changes are small and shrink no more. What they leave is the loss's to judge.
    recent[since_factor % 4] = size;
    const bool stagnant =
        since_factor >= 8 && size<options.stagnation * options.tolerance&& * std::min_element(recent, recent + 4)> 0.3 *
                                 recent[(since_factor + 1) % 4];
    if (stagnant) {
      result.last_change = size;
      result.converged = true;
      return result;
    }
    if (diverged || since_factor > (result.factored ? options.fresh_iterations : options.stale_iterations)) {
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
