#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "support/stated_system.hpp"

namespace orbweaver::test {

/// A system given state by state, with a Jacobian written by hand; for tests whose multipliers are known by pencil.
class PointSystem : public StatedSystem {
 public:
  explicit PointSystem(systems::Structure structure) : StatedSystem(std::move(structure)) {}

  [[nodiscard]] virtual Eigen::VectorXd field_at(const Eigen::VectorXd& z) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const = 0;
  [[nodiscard]] virtual Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const {
    return Eigen::VectorXd::Zero(z.size());
  }

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) scatter(nodes, j, field_at(gather(nodes, j, z)), f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      const Eigen::MatrixXd matrix = jacobian_at(gather(nodes, j, z)).transpose();
      scatter(nodes, j, Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size()), jacobian);
    }
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    const Eigen::VectorXd value =
        gradient_at(Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size())));
    std::copy(value.data(), value.data() + value.size(), gradient.begin());
  }

 private:
  [[nodiscard]] Eigen::VectorXd gather(std::size_t nodes, std::size_t j, const double* z) const {
    Eigen::VectorXd point(dimension());
    for (Eigen::Index i = 0; i < point.size(); ++i) point[i] = z[static_cast<std::size_t>(i) * nodes + j];
    return point;
  }
  static void scatter(std::size_t nodes, std::size_t j, const Eigen::VectorXd& values, double* out) {
    for (Eigen::Index i = 0; i < values.size(); ++i) out[static_cast<std::size_t>(i) * nodes + j] = values[i];
  }
};

/// q_i'' = -stiffness_i q_i, uncoupled: state q_0, p_0, q_1, p_1, ... A negative stiffness is a saddle.
class Oscillators final : public PointSystem {
 public:
  explicit Oscillators(std::vector<double> stiffness)
      : PointSystem(describe(stiffness.size())), _stiffness(std::move(stiffness)) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override { return jacobian_at(z) * z; }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(z.size(), z.size());
    for (std::size_t n = 0; n < _stiffness.size(); ++n) {
      const auto i = static_cast<Eigen::Index>(2 * n);
      matrix(i, i + 1) = 1.0;
      matrix(i + 1, i) = -_stiffness[n];
    }
    return matrix;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    Eigen::VectorXd gradient = z;
    for (std::size_t n = 0; n < _stiffness.size(); ++n) gradient[static_cast<Eigen::Index>(2 * n)] *= _stiffness[n];
    return gradient;
  }

 private:
  static systems::Structure describe(std::size_t count) {
    systems::Structure structure = structure_of(static_cast<int>(2 * count), true, true);
    const auto d = static_cast<Eigen::Index>(2 * count);
    structure.equivariances = {{"S", -Eigen::MatrixXd::Identity(d, d)}};
    Eigen::MatrixXd reversor = Eigen::MatrixXd::Identity(d, d);
    for (Eigen::Index i = 1; i < d; i += 2) reversor(i, i) = -1.0;
    structure.reversors = {{"R", reversor}};
    return structure;
  }
  std::vector<double> _stiffness;
};

/// Hopf's normal form r' = r (growth - r^2), angle' = 1, with a third coordinate z' = -decay z: the limit cycle
/// r = sqrt(growth) has the multipliers exp(-2 growth T) and exp(-decay T), T = 2 pi.
class HopfCycle final : public PointSystem {
 public:
  HopfCycle(double growth, double decay) : PointSystem(describe()), _growth(growth), _decay(decay) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    const double pull = _growth - z[0] * z[0] - z[1] * z[1];
    return Eigen::Vector3d(pull * z[0] - z[1], z[0] + pull * z[1], -_decay * z[2]);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    const double pull = _growth - z[0] * z[0] - z[1] * z[1];
    Eigen::Matrix3d matrix;
    matrix << pull - 2 * z[0] * z[0], -1.0 - 2 * z[0] * z[1], 0, 1.0 - 2 * z[0] * z[1], pull - 2 * z[1] * z[1], 0, 0, 0,
        -_decay;
    return matrix;
  }

 private:
  static systems::Structure describe() {
    systems::Structure structure = structure_of(3);
    structure.equivariances = {{"S", Eigen::Matrix3d(Eigen::Vector3d(-1, -1, 1).asDiagonal())}};
    return structure;
  }
  double _growth;
  double _decay;
};

/// Euler's equations of a free symmetric top: conserves energy, is not symplectic. a' = -s b c, b' = s a c, c' = 0.
class SymmetricTop final : public PointSystem {
 public:
  explicit SymmetricTop(double s) : PointSystem(describe()), _s(s) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector3d(-_s * z[1] * z[2], _s * z[0] * z[2], 0.0);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix3d matrix;
    matrix << 0, -_s * z[2], -_s * z[1], _s * z[2], 0, _s * z[0], 0, 0, 0;
    return matrix;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override { return z; }

 private:
  static systems::Structure describe() { return structure_of(3, true); }
  double _s;
};

}  // namespace orbweaver::test
