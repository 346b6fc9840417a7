#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// A system given state by state, with a Jacobian written by hand; for tests whose multipliers are known by pencil.
class PointSystem : public systems::System {
 public:
  explicit PointSystem(systems::Description description) : _description(std::move(description)) {}

  [[nodiscard]] const systems::Description& description() const override { return _description; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }

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
  void second_derivatives(std::size_t, const double*, const double*, double*) const override {
    throw std::logic_error("second derivatives are not used by Floquet multipliers");
  }
  [[nodiscard]] double energy(std::span<const double>) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  void energy_gradient(std::span<const double> z, std::span<double> gradient) const override {
    const Eigen::VectorXd value =
        gradient_at(Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size())));
    std::copy(value.data(), value.data() + value.size(), gradient.begin());
  }
  [[nodiscard]] double action_density(std::span<const double>) const override {
    return std::numeric_limits<double>::quiet_NaN();
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

  systems::Description _description;
  std::map<std::string, double> _parameters;
};

inline systems::Description description_of(std::vector<std::string> states) {
  systems::Description description;
  description.name = "test";
  description.state_names = std::move(states);
  return description;
}

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
  static systems::Description describe(std::size_t count) {
    std::vector<std::string> names;
    for (std::size_t n = 0; n < count; ++n) {
      for (const char* letter : {"q", "p"}) names.emplace_back(letter).append(std::to_string(n));
    }
    systems::Description description = description_of(names);
    const auto d = static_cast<Eigen::Index>(2 * count);
    description.equivariances = {{"S", -Eigen::MatrixXd::Identity(d, d)}};
    Eigen::MatrixXd reversor = Eigen::MatrixXd::Identity(d, d);
    for (Eigen::Index i = 1; i < d; i += 2) reversor(i, i) = -1.0;
    description.reversors = {{"R", reversor}};
    description.conservative = true;
    description.symplectic = true;
    return description;
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
  static systems::Description describe() {
    systems::Description description = description_of({"x", "y", "z"});
    description.equivariances = {{"S", Eigen::Vector3d(-1, -1, 1).asDiagonal()}};
    return description;
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
  static systems::Description describe() {
    systems::Description description = description_of({"a", "b", "c"});
    description.conservative = true;
    return description;
  }
  double _s;
};

}  // namespace orbweaver::test
