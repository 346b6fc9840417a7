#include "drive_averaged.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbweaver/numerics/two_pi.hpp"
#include "orbweaver/systems/drive_averaged.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of a drive with a few harmonics. A power of two, so that the mean of equal values is exact.
constexpr int drive_phases = 8;

/// An entry of the Jacobian whose mean is less than this share of what it is over the phases tells no rate: what is
/// left of it may be rounding, or a high harmonic of the drive.
constexpr double cancelled = 0.1;

}  // namespace

DriveAveraged::DriveAveraged(std::shared_ptr<const systems::System> driven)
    : _driven(std::move(driven)), _mean(systems::averaged_over_drive(_driven, drive_phases)) {}

Eigen::MatrixXd DriveAveraged::strength(const VectorXd& z) const {
  const Index d = z.size();
  VectorXd state = z;
  VectorXd values(d);
  RowMajor jacobian(d, d);
  RowMajor squares = RowMajor::Zero(d, d);
  for (int n = 0; n < drive_phases; ++n) {
    state(d - 1) = numerics::two_pi * n / drive_phases;
    _driven->field_jacobian(1, state.data(), values.data(), jacobian.data());
    squares += jacobian.cwiseAbs2();
  }
  _mean->field_jacobian(1, z.data(), values.data(), jacobian.data());
  for (Index i = 0; i < d; ++i)
    for (Index l = 0; l + 1 < d; ++l)
      if (const double strong = std::sqrt(squares(i, l) / drive_phases); std::abs(jacobian(i, l)) < cancelled * strong)
        jacobian(i, l) = std::copysign(strong, jacobian(i, l));
  return jacobian;
}

VectorXd DriveAveraged::departure(const VectorXd& z) const {
  VectorXd average(z.size());
  _mean->field(1, z.data(), average.data());
  VectorXd largest = VectorXd::Zero(z.size());
  VectorXd state = z;
  VectorXd values(z.size());
  for (int n = 0; n < drive_phases; ++n) {
    state(z.size() - 1) = numerics::two_pi * n / drive_phases;
    _driven->field(1, state.data(), values.data());
    largest = largest.cwiseMax((values - average).cwiseAbs());
  }
  return largest;
}

}  // namespace orbweaver::starts
