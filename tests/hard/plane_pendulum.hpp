#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "spectrum/point_systems.hpp"

namespace orbweaver::test {

/// q'' = -sin q, state q, p: from rest at q = A the period is 2 pi/agm(1, cos(A/2)).
class PlanePendulum final : public PointSystem {
 public:
  PlanePendulum() : PointSystem(described()) {}

  [[nodiscard]] Eigen::VectorXd field_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(z[1], -std::sin(z[0]));
  }
  [[nodiscard]] Eigen::MatrixXd jacobian_at(const Eigen::VectorXd& z) const override {
    Eigen::Matrix2d a;
    a << 0.0, 1.0, -std::cos(z[0]), 0.0;
    return a;
  }
  [[nodiscard]] Eigen::VectorXd gradient_at(const Eigen::VectorXd& z) const override {
    return Eigen::Vector2d(std::sin(z[0]), z[1]);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * z[1] * z[1] - std::cos(z[0]);
  }

  /// q = cos t, p = -sin t.
  [[nodiscard]] static loop::Loop small_oscillation() {
    loop::Loop loop = loop::constant_loop(std::vector<double>(2, 0.0), 2.0 * std::numbers::pi, 8);
    loop.cosine(1, 0) = 1.0;
    loop.sine(1, 1) = -1.0;
    return loop;
  }
  /// S@1/2 R@0: that of all orbits around 0 which begin at rest.
  [[nodiscard]] static loop::Isotropy isotropy() { return loop::find_isotropy(described(), small_oscillation(), 1e-9); }

 private:
  static systems::Structure described() {
    systems::Structure d = structure_of(2, true, true);
    d.equivariances = {{"S", -Eigen::Matrix2d::Identity()}};
    d.reversors = {{"R", Eigen::Matrix2d(Eigen::Vector2d(1, -1).asDiagonal())}};
    return d;
  }
};

}  // namespace orbweaver::test
