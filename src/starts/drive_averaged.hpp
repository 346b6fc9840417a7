#pragma once

#include <memory>

#include <Eigen/Core>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::starts {

/// A driven system and the mean of its field over the phases of its drive.
class DriveAveraged {
 public:
  explicit DriveAveraged(std::shared_ptr<const systems::System> driven);

  [[nodiscard]] const std::shared_ptr<const systems::System>& mean() const { return _mean; }

  /// The Jacobian there for scales: its mean, or, where that is little of an entry since what it does turns with the
  /// drive, the root of the mean square of that.
  [[nodiscard]] Eigen::MatrixXd strength(const Eigen::VectorXd& z) const;

  /// How far the field there departs from its mean at most, over the phases; one a coordinate.
  [[nodiscard]] Eigen::VectorXd departure(const Eigen::VectorXd& z) const;

 private:
  std::shared_ptr<const systems::System> _driven;
  std::shared_ptr<const systems::System> _mean;
};

}  // namespace orbweaver::starts
