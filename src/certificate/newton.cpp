#include "newton.hpp"
#include "orbweaver/numerics/decompositions.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::certificate {

NewtonSystem::NewtonSystem(const std::vector<Eigen::MatrixXd>& transitions, const std::vector<Eigen::VectorXd>& fields,
                           int rank)
    : _dimension(static_cast<int>(fields.front().size())), _rank(rank) {
  const auto count = transitions.size();
  const auto share = 1.0 / static_cast<double>(count);
  const Eigen::Index d = _dimension;
  double squares = 0.0;
  for (const Eigen::VectorXd& field : fields) squares += field.squaredNorm();
  const double rms = std::sqrt(squares / static_cast<double>(fields.size()));
  if (rms > 0.0) _speed = rms;
  Matrix first = transitions.front();
  Matrix next = -Matrix::Identity(d, d);
  Eigen::VectorXd period = fields[1] * share;
  for (std::size_t m = 1; m < count; ++m) {
    Matrix pivot(2 * d, d);
    pivot << next, transitions[m];
    Matrix rest = Matrix::Zero(2 * d, 2 * d + 1);
    rest.topLeftCorner(d, d) = first;
    rest.block(d, d, d, d) = -Matrix::Identity(d, d);
    rest.col(2 * d) << period, fields[m + 1] * share;
    Pivot step{Eigen::HouseholderQR<Matrix>(pivot), {}, {}, {}};
    rest.applyOnTheLeft(step.factors.householderQ().adjoint());
    step.first = rest.topLeftCorner(d, d);
    step.next = rest.block(0, d, d, d);
    step.period = rest.col(2 * d).head(d);
    first = rest.block(d, 0, d, d);
    next = rest.block(d, d, d, d);
    period = rest.col(2 * d).tail(d);
    _pivots.push_back(std::move(step));
  }
  Matrix closing(d, d + 1);
  closing << first + next, period / _speed;
  _closing.compute(closing, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

NewtonSystem::Step NewtonSystem::solve(const std::vector<Eigen::VectorXd>& gaps) const {
  const Eigen::Index d = _dimension;
  std::vector<Eigen::VectorXd> right;
  Eigen::VectorXd gap = gaps.front();
  for (std::size_t m = 1; m < gaps.size(); ++m) {
    Eigen::VectorXd both(2 * d);
    both << gap, gaps[m];
    both.applyOnTheLeft(_pivots[m - 1].factors.householderQ().adjoint());
    right.emplace_back(both.head(d));
    gap = both.tail(d);
  }
  const Eigen::VectorXd turned = _closing.matrixU().adjoint() * gap;
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(d + 1);
  for (Eigen::Index n = 0; n < std::min<Eigen::Index>(_rank, d); ++n)
    if (_closing.singularValues()(n) > 0.0)
      solution += turned(n) / _closing.singularValues()(n) * _closing.matrixV().col(n);
  Step step;
  step.period = solution(d) / _speed;
  step.states.resize(gaps.size());
  step.states.front() = solution.head(d);
  for (std::size_t m = gaps.size(); m-- > 1;) {
    const Pivot& pivot = _pivots[m - 1];
    const Eigen::VectorXd& after = m + 1 == gaps.size() ? step.states.front() : step.states[m + 1];
    const Eigen::VectorXd known =
        right[m - 1] - pivot.first * step.states.front() - pivot.next * after - pivot.period * step.period;
    step.states[m] = pivot.factors.matrixQR().topRows(d).template triangularView<Eigen::Upper>().solve(known);
  }
  return step;
}

}  // namespace orbweaver::certificate
