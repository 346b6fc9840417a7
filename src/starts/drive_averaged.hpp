#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>

#include <Eigen/Core>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// The mean of a driven field over the phases of its drive, which changes nothing where the drive is at zero. It rests
/// where the drive pushes around, and where the driven system itself may not.
class DriveAveraged final : public systems::System {
 public:
  /// Of a driven system, which must outlive it.
  explicit DriveAveraged(const systems::System& base);

  [[nodiscard]] const systems::ModelInfo& info() const override { return _base.info(); }
  [[nodiscard]] const systems::Structure& structure() const override { return _base.structure(); }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _base.parameters(); }

  void field(std::size_t nodes, const double* z, double* f) const override;
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override;
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* contracted) const override;

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override { return _base.conserved(k, z); }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    _base.conserved_gradient(k, z, gradient);
  }
  [[nodiscard]] double guard(int k, std::span<const double> z) const override { return _base.guard(k, z); }
  [[nodiscard]] double action_density(std::span<const double> z) const override { return _base.action_density(z); }

  /// The Jacobian there for scales: its mean, or, where that is little of an entry since what it does turns with the
  /// drive, the root of the mean square of that.
  [[nodiscard]] Eigen::MatrixXd strength(const Eigen::VectorXd& z) const;

  /// How far the field there departs from its mean at most, over the phases; one a coordinate.
  [[nodiscard]] Eigen::VectorXd departure(const Eigen::VectorXd& z) const;

 private:
  using Values = std::function<Eigen::VectorXd(const double* z)>;
  [[nodiscard]] Eigen::VectorXd mean(std::size_t nodes, const double* z, const Values& values) const;

  const systems::System& _base;
};

}  // namespace orbweaver::starts
