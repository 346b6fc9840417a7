#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/numerics/decompositions.hpp"
#include "support/delegating_system.hpp"

namespace orbweaver::test {

/// The matrix that takes coordinate n to the place order[n].
[[nodiscard]] inline Eigen::MatrixXd exchange(const std::vector<int>& order) {
  const auto n = static_cast<Eigen::Index>(order.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) matrix(order[static_cast<std::size_t>(i)], i) = 1.0;
  return matrix;
}

/// Positions and velocities of a plane turned by one angle.
[[nodiscard]] inline Eigen::MatrixXd rotation(double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4, 4);
  matrix.topLeftCorner(2, 2) = turn;
  matrix.bottomRightCorner(2, 2) = turn;
  return matrix;
}

/// The same system told in other coordinates y = Q z, Q invertible, and other units of time and energy (how many of
/// them make an old one): dy/dt = Q f(Q^-1 y)/time, with its symmetries Q A Q^-1. Angles only change places.
class TurnedSystem final : public DelegatingSystem {
 public:
  TurnedSystem(std::shared_ptr<const systems::System> system, const Eigen::MatrixXd& turn, double time = 1.0,
               double energy = 1.0)
      : DelegatingSystem(std::move(system)),
        _turn(turn),
        _back(turn.inverse()),
        _time(time),
        _energy(energy),
        _structure(whole().structure()),
        _info(whole().info()) {
    const systems::AffineMap there{_turn, Eigen::VectorXd::Zero(_turn.rows())};
    for (auto* symmetries : {&_structure.equivariances, &_structure.reversors})
      for (systems::Symmetry& s : *symmetries) s.map = there * s.map * there.inverse();
    for (int& angle : _structure.angles) angle = static_cast<int>(place_of(angle));
    std::sort(_structure.angles.begin(), _structure.angles.end());
    if (_structure.angles.empty()) return;
    for (Eigen::Index i = 0; i < _turn.cols(); ++i) {
      const auto place = static_cast<std::size_t>(place_of(i));
      _info.state_names[place] = whole().info().state_names[static_cast<std::size_t>(i)];
      _info.winding_names[place] = whole().info().winding_names[static_cast<std::size_t>(i)];
    }
  }

  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }
  [[nodiscard]] const systems::ModelInfo& info() const override { return _info; }

  void field(std::size_t nodes, const double* y, double* f) const override {
    whole().field(nodes, times(_back, nodes, y).data(), f);
    std::ranges::copy(times(_turn / _time, nodes, f), f);
  }
  void field_jacobian(std::size_t nodes, const double* y, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, times(_back, nodes, y).data(), f, jacobian);
    std::ranges::copy(times(_turn / _time, nodes, f), f);
    between(_turn / _time, _back, nodes, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* y, const double* weights, double* out) const override {
    const std::vector<double> turned = times(_turn.transpose() / _time, nodes, weights);
    whole().second_derivatives(nodes, times(_back, nodes, y).data(), turned.data(), out);
    between(_back.transpose(), _back, nodes, out);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> y) const override {
    return _energy * whole().conserved(k, times(_back, 1, y.data()));
  }
  void conserved_gradient(int k, std::span<const double> y, std::span<double> gradient) const override {
    whole().conserved_gradient(k, times(_back, 1, y.data()), gradient);
    std::ranges::copy(times(_energy * _back.transpose(), 1, gradient.data()), gradient.begin());
  }
  [[nodiscard]] double action_density(std::span<const double> y) const override {
    return _energy * whole().action_density(times(_back, 1, y.data()));
  }
  [[nodiscard]] double guard(int k, std::span<const double> y) const override {
    return whole().guard(k, times(_back, 1, y.data()));
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] Eigen::Index place_of(Eigen::Index coordinate) const {
    Eigen::Index place = 0;
    _turn.col(coordinate).cwiseAbs().maxCoeff(&place);
    return place;
  }
  static std::vector<double> times(const Eigen::MatrixXd& matrix, std::size_t nodes, const double* z) {
    const auto n = static_cast<Eigen::Index>(nodes);
    std::vector<double> out(nodes * static_cast<std::size_t>(matrix.rows()));
    Eigen::Map<Rows>(out.data(), matrix.rows(), n) = matrix * Eigen::Map<const Rows>(z, matrix.rows(), n);
    return out;
  }
  /// L M R of the matrix M at each node.
  static void between(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right, std::size_t nodes, double* matrices) {
    const Eigen::Index d = left.rows();
    for (std::size_t node = 0; node < nodes; ++node) {
      const Eigen::Map<Rows, 0, Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>> m(
          matrices + node, d, d, {d * static_cast<Eigen::Index>(nodes), static_cast<Eigen::Index>(nodes)});
      const Eigen::MatrixXd product = left * m * right;
      for (Eigen::Index i = 0; i < d; ++i)
        for (Eigen::Index l = 0; l < d; ++l)
          matrices[static_cast<std::size_t>(i * d + l) * nodes + node] = product(i, l);
    }
  }

  Eigen::MatrixXd _turn;
  Eigen::MatrixXd _back;
  double _time;
  double _energy;
  systems::Structure _structure;
  systems::ModelInfo _info;
};

}  // namespace orbweaver::test
