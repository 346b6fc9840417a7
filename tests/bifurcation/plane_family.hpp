#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "orbweaver/loop/curve/loop.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::test {

/// H = I + x' A x / 2 with I = (q^2 + p^2)/2 and A = A_0 + I A_I + q A_q + p A_p; state q, p, x = (x_1, y_1, x_2, y_2,
/// ..). In the invariant plane x = 0 lie circles q = r cos t, p = -r sin t with period 2 pi, one for each I = r^2/2.
/// Along one of them dx/dt = J A(t) x, J made of blocks (0 1; -1 0).
class PlaneFamily final : public PointSystem {
 public:
  struct Forms {
    Eigen::MatrixXd constant;
    Eigen::MatrixXd by_action;
    Eigen::MatrixXd by_q;
    Eigen::MatrixXd by_p;
  };
  /// Empty forms count as zero. `mirrored`: x -> -x is declared, `turned`: z -> -z (needs by_q = by_p = 0).
  explicit PlaneFamily(Forms forms, bool turned = false)
      : PointSystem(describe(forms.constant.rows(), turned)), _forms(std::move(forms)) {
    for (Eigen::MatrixXd* form : {&_forms.by_action, &_forms.by_q, &_forms.by_p})
      if (form->size() == 0) *form = Eigen::MatrixXd::Zero(_forms.constant.rows(), _forms.constant.cols());
  }

  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    const Eigen::VectorXd x = z.tail(z.size() - 2);
    Eigen::VectorXd gradient(z.size());
    gradient[0] = z[0] + 0.5 * x.dot(by(0, z) * x);
    gradient[1] = z[1] + 0.5 * x.dot(by(1, z) * x);
    gradient.tail(x.size()) = form_at(z) * x;
    return gradient;
  }
  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return turned_by_j(gradient_at(z));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const Eigen::VectorXd x = z.tail(z.size() - 2);
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(z.size(), z.size());
    for (Eigen::Index i = 0; i < 2; ++i) {
      hessian(i, i) = 1.0 + 0.5 * x.dot(_forms.by_action * x);
      hessian.row(i).tail(x.size()) = (by(i, z) * x).transpose();
      hessian.col(i).tail(x.size()) = by(i, z) * x;
    }
    hessian.bottomRightCorner(x.size(), x.size()) = form_at(z);
    return turned_by_j(hessian);
  }

  [[nodiscard]] loop::Loop circle(double action) const {
    loop::Loop loop =
        loop::constant_loop(std::vector<double>(static_cast<std::size_t>(dimension()), 0.0), 2.0 * std::numbers::pi, 3);
    loop.cosine(1, 0) = std::sqrt(2.0 * action);
    loop.sine(1, 1) = -std::sqrt(2.0 * action);
    return loop;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd form_at(const Eigen::VectorXd& z) const {
    return _forms.constant + 0.5 * (z[0] * z[0] + z[1] * z[1]) * _forms.by_action + z[0] * _forms.by_q +
           z[1] * _forms.by_p;
  }
  /// dA/dq and dA/dp.
  [[nodiscard]] Eigen::MatrixXd by(Eigen::Index i, const Eigen::VectorXd& z) const {
    return z[i] * _forms.by_action + (i == 0 ? _forms.by_q : _forms.by_p);
  }
  template <class Matrix>
  [[nodiscard]] static Matrix turned_by_j(Matrix matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); i += 2) {
      const auto q_row = matrix.row(i).eval();
      matrix.row(i) = matrix.row(i + 1).eval();
      matrix.row(i + 1) = -q_row;
    }
    return matrix;
  }
  static systems::Structure describe(Eigen::Index transverse, bool turned) {
    systems::Structure structure = structure_of(static_cast<int>(2 + transverse), true, true);
    if (turned) structure.equivariances = {{"S", -Eigen::MatrixXd::Identity(2 + transverse, 2 + transverse)}};
    return structure;
  }
  Forms _forms;
};

/// The limit cycle u = cos t, v = sin t of Hopf's normal form (its own contraction exp(-4 pi)), and beside it
/// dw/dt = (s + d (u v; v -u) + turn J) w in the plane w, J = (0 -1; 1 0). In axes that turn half as fast as the cycle
/// this has constant coefficients: the multipliers are -exp(2 pi (s +- sqrt(d^2 - (turn - 1/2)^2))).
class PlaneCycle final : public PointSystem {
 public:
  PlaneCycle(double s, double d, double turn) : PointSystem(structure_of(4)), _s(s), _d(d), _turn(turn) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const double pull = 1.0 - z[0] * z[0] - z[1] * z[1];
    const Eigen::Vector2d beside = plane(z) * z.tail(2);
    return Eigen::Vector4d(pull * z[0] - z[1], z[0] + pull * z[1], beside[0], beside[1]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const double pull = 1.0 - z[0] * z[0] - z[1] * z[1];
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    matrix.topLeftCorner(2, 2) << pull - 2 * z[0] * z[0], -1.0 - 2 * z[0] * z[1], 1.0 - 2 * z[0] * z[1],
        pull - 2 * z[1] * z[1];
    matrix.bottomLeftCorner(2, 2) << _d * z[2], _d * z[3], -_d * z[3], _d * z[2];
    matrix.bottomRightCorner(2, 2) = plane(z);
    return matrix;
  }
  [[nodiscard]] static loop::Loop cycle() {
    loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * std::numbers::pi, 3);
    loop.cosine(1, 0) = 1.0;
    loop.sine(1, 1) = 1.0;
    return loop;
  }

 private:
  [[nodiscard]] Eigen::Matrix2d plane(const Eigen::VectorXd& z) const {
    Eigen::Matrix2d matrix;
    matrix << _s + _d * z[0], _d * z[1] - _turn, _d * z[1] + _turn, _s - _d * z[0];
    return matrix;
  }
  double _s;
  double _d;
  double _turn;
};

}  // namespace orbweaver::test
