#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

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

/// The same system in other coordinates y = Q z, Q orthogonal: dy/dt = Q f(Q' y), with its symmetries Q A Q'. Angles
/// only change places.
class TurnedSystem final : public DelegatingSystem {
 public:
  TurnedSystem(std::shared_ptr<const systems::System> system, Eigen::MatrixXd turn)
      : DelegatingSystem(std::move(system)),
        _turn(std::move(turn)),
        _structure(whole().structure()),
        _info(whole().info()) {
    const systems::AffineMap there{_turn, Eigen::VectorXd::Zero(_turn.rows())};
    for (auto* symmetries : {&_structure.equivariances, &_structure.reversors})
      for (systems::Symmetry& s : *symmetries) s.map = there * s.map * there.inverse();
    for (int& angle : _structure.angles) {
      Eigen::Index place = 0;
      _turn.col(angle).cwiseAbs().maxCoeff(&place);
      angle = static_cast<int>(place);
    }
    std::sort(_structure.angles.begin(), _structure.angles.end());
    for (Eigen::Index i = 0; i < _turn.cols(); ++i) {
      Eigen::Index place = 0;
      if (_turn.col(i).cwiseAbs().maxCoeff(&place) < 1.0) continue;  // a mixture keeps the name of its place
      _info.state_names[static_cast<std::size_t>(place)] = whole().info().state_names[static_cast<std::size_t>(i)];
      _info.winding_names[static_cast<std::size_t>(place)] = whole().info().winding_names[static_cast<std::size_t>(i)];
    }
  }

  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }
  [[nodiscard]] const systems::ModelInfo& info() const override { return _info; }

  void field(std::size_t nodes, const double* y, double* f) const override {
    whole().field(nodes, back(nodes, y).data(), f);
    const std::vector<double> before(f, f + nodes * size());
    turn(nodes, before.data(), f);
  }
  void field_jacobian(std::size_t nodes, const double* y, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, back(nodes, y).data(), f, jacobian);
    const std::vector<double> before(f, f + nodes * size());
    turn(nodes, before.data(), f);
    conjugate(nodes, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* y, const double* weights, double* out) const override {
    whole().second_derivatives(nodes, back(nodes, y).data(), back(nodes, weights).data(), out);
    conjugate(nodes, out);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> y) const override {
    return whole().conserved(k, back(1, y.data()));
  }
  void conserved_gradient(int k, std::span<const double> y, std::span<double> gradient) const override {
    std::vector<double> before(size());
    whole().conserved_gradient(k, back(1, y.data()), before);
    turn(1, before.data(), gradient.data());
  }
  [[nodiscard]] double action_density(std::span<const double> y) const override {
    return whole().action_density(back(1, y.data()));
  }
  [[nodiscard]] double guard(int k, std::span<const double> y) const override {
    return whole().guard(k, back(1, y.data()));
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_turn.rows()); }
  [[nodiscard]] std::vector<double> back(std::size_t nodes, const double* y) const {
    std::vector<double> z(nodes * size());
    const auto n = static_cast<Eigen::Index>(nodes);
    Eigen::Map<Rows>(z.data(), _turn.rows(), n) = _turn.transpose() * Eigen::Map<const Rows>(y, _turn.rows(), n);
    return z;
  }
  void turn(std::size_t nodes, const double* z, double* y) const {
    const auto n = static_cast<Eigen::Index>(nodes);
    Eigen::Map<Rows>(y, _turn.rows(), n) = _turn * Eigen::Map<const Rows>(z, _turn.rows(), n);
  }
  /// Q M Q' of the matrix at each node.
  void conjugate(std::size_t nodes, double* matrices) const {
    const std::size_t d = size();
    for (std::size_t node = 0; node < nodes; ++node) {
      Eigen::MatrixXd m(d, d);
      const auto entry = [&](Eigen::Index i, Eigen::Index l) -> double& {
        return matrices[(static_cast<std::size_t>(i) * d + static_cast<std::size_t>(l)) * nodes + node];
      };
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index l = 0; l < m.cols(); ++l) m(i, l) = entry(i, l);
      m = _turn * m * _turn.transpose();
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index l = 0; l < m.cols(); ++l) entry(i, l) = m(i, l);
    }
  }

  Eigen::MatrixXd _turn;
  systems::Structure _structure;
  systems::ModelInfo _info;
};

}  // namespace orbweaver::test
