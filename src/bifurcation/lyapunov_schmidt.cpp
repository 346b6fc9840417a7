#include "lyapunov_schmidt.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::bifurcation {

namespace {

using Complex = std::complex<double>;

constexpr Complex i_unit{0.0, 1.0};
constexpr int nodes_a_harmonic = 4;
constexpr double singular = 1e-10;
constexpr double pure = 1e-6;  // of a unit kernel vector: what other harmonics may have
/// A reduction converges by the amplitude a step, and ends where it changes by this part of that.
constexpr int most_steps = 60;
constexpr double reduced = 1e-13;

}  // namespace

LyapunovSchmidt::LyapunovSchmidt(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                                 int order)
    : _system(system), _base(base), _group(group), _d(base.dimension) {
  const Eigen::Index size = group.dimension();
  _vectors.resize(_d, size);
  std::map<int, std::vector<Eigen::Index>> of_harmonic;
  for (Eigen::Index c = 0; c < size; ++c) {
    const loop::Loop v = loop::perturbation(base, group.vector_at(Eigen::VectorXd::Unit(size, c)));
    for (int k = 1; k <= v.cutoff; ++k) {
      Eigen::VectorXcd wave(_d);
      for (int i = 0; i < base.dimension; ++i) wave(i) = {v.cosine(k, i), -v.sine(k, i)};
      if (wave.norm() < pure) continue;
      _vectors.col(c) = wave;
      of_harmonic[k].push_back(c);
    }
  }
  _basis.resize(_d, 0);
  for (const auto& [k, columns] : of_harmonic) {
    const auto count = static_cast<Eigen::Index>(columns.size()) / 2;
    const Eigen::JacobiSVD<Eigen::MatrixXcd> factor(_vectors(Eigen::all, columns), Eigen::ComputeThinU);
    _basis.conservativeResize(Eigen::NoChange, _basis.cols() + count);
    _basis.rightCols(count) = factor.matrixU().leftCols(count);
    _around.conservativeResize(_basis.cols());
    _around.tail(count).setConstant(k);
  }
  _in_kernel = Eigen::MatrixXcd::Zero(_basis.cols(), size);
  for (const auto& [k, columns] : of_harmonic)
    for (const Eigen::Index c : columns)
      for (Eigen::Index m = 0; m < _basis.cols(); ++m)
        if (_around(m) == k) _in_kernel(m, c) = _basis.col(m).dot(_vectors.col(c));
  for (int i = 0; i < base.dimension; ++i) _point.push_back(base.cosine(0, i));
  linearize(order);
}

Eigen::VectorXd LyapunovSchmidt::coordinates(const Eigen::VectorXcd& amplitudes) const {
  loop::Loop modes = _base;
  std::fill(modes.modes.begin(), modes.modes.end(), 0.0);
  for (Eigen::Index m = 0; m < amplitudes.size(); ++m) {
    const Eigen::VectorXcd v = _basis.col(m) * amplitudes(m);
    const int k = static_cast<int>(_around(m));
    for (int i = 0; i < _base.dimension; ++i) {
      modes.cosine(k, i) += v(i).real();
      modes.sine(k, i) -= v(i).imag();
    }
  }
  return _group.coordinates_of(modes.modes);
}

std::optional<Eigen::VectorXcd> LyapunovSchmidt::force(const Eigen::VectorXcd& amplitudes) const {
  Eigen::MatrixXcd inside = Eigen::MatrixXcd::Zero(_d, static_cast<Eigen::Index>(_solvers.size()));
  for (Eigen::Index m = 0; m < amplitudes.size(); ++m)
    inside.col(static_cast<Eigen::Index>(_around(m))) += _basis.col(m) * amplitudes(m);
  Eigen::MatrixXcd u = inside;
  Eigen::VectorXcd force = Eigen::VectorXcd::Zero(amplitudes.size());
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::MatrixXcd rest = nonlinear(u);
    if (!rest.allFinite()) return std::nullopt;
    Eigen::MatrixXcd next = inside;
    Eigen::VectorXcd last = force;
    for (Eigen::Index k = 0; k < u.cols(); ++k) {
      const Solver& solver = _solvers[static_cast<std::size_t>(k)];
      Eigen::VectorXcd right = Eigen::VectorXcd::Zero(_d + static_cast<Eigen::Index>(solver.members.size()));
      right.head(_d) = rest.col(k) - solver.matrix * inside.col(k);
      const Eigen::VectorXcd solution = solver.factor.solve(right);
      next.col(k) += solution.head(_d);
      force(solver.members) = solution.tail(right.size() - _d);
    }
    const double change = (next - u).norm() + (force - last).norm();
    u = std::move(next);
    if (change < reduced * amplitudes.norm()) return force;
  }
  return std::nullopt;
}

void LyapunovSchmidt::linearize(int order) {
  std::vector<double> field(_point.size());
  std::vector<double> jacobian(_point.size() * _point.size());
  _system.field_jacobian(1, _point.data(), field.data(), jacobian.data());
  _jacobian =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(jacobian.data(), _d, _d);
  const double frequency = 2.0 * std::numbers::pi / _base.period;
  const int highest = order * static_cast<int>(_around.maxCoeff());
  for (int k = 0; k <= highest; ++k) {
    Solver& solver = _solvers.emplace_back(Solver{-_jacobian.cast<Complex>(), {}});
    solver.matrix.diagonal().array() += i_unit * (k * frequency);
    for (Eigen::Index m = 0; m < _around.size(); ++m)
      if (_around(m) == k) solver.members.push_back(m);
    const auto borders = static_cast<Eigen::Index>(solver.members.size());
    Eigen::MatrixXcd bordered = Eigen::MatrixXcd::Zero(_d + borders, _d + borders);
    bordered.topLeftCorner(_d, _d) = solver.matrix;
    bordered.topRightCorner(_d, borders) = _basis(Eigen::all, solver.members);
    bordered.bottomLeftCorner(borders, _d) = bordered.topRightCorner(_d, borders).adjoint();
    solver.factor.setThreshold(singular);
    solver.factor.compute(bordered, Eigen::ComputeThinU | Eigen::ComputeThinV);
  }
  const int nodes = nodes_a_harmonic * highest;
  _waves.resize(nodes, highest + 1);
  for (int j = 0; j < nodes; ++j)
    for (int k = 0; k <= highest; ++k) _waves(j, k) = std::polar(1.0, 2.0 * std::numbers::pi * j * k / nodes);
}

Eigen::MatrixXcd LyapunovSchmidt::nonlinear(const Eigen::MatrixXcd& u) const {
  const Eigen::MatrixXd aside = (_waves * u.transpose()).real();  // nodes x d
  Eigen::MatrixXd z = aside;
  for (Eigen::Index i = 0; i < _d; ++i) z.col(i).array() += _point[static_cast<std::size_t>(i)];
  Eigen::MatrixXd f(z.rows(), _d);
  _system.field(static_cast<std::size_t>(z.rows()), z.data(), f.data());
  f -= aside * _jacobian.transpose();
  Eigen::MatrixXcd out = (2.0 / static_cast<double>(z.rows())) * f.transpose().cast<Complex>() * _waves.conjugate();
  out.col(0) *= 0.5;
  return out;
}

}  // namespace orbweaver::bifurcation
