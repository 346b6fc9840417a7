#include "drive_averaged.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/two_pi.hpp"

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

/// Of the values at first, first + step, ... below `drive_phases`: opposite phases are added first, so that what goes
/// with the cosine cancels.
template <class At>
VectorXd mean_from(int first, int step, const At& at) {
  if (step == drive_phases) return at(first);
  return 0.5 * (mean_from(first, 2 * step, at) + mean_from(first + step, 2 * step, at));
}

}  // namespace

DriveAveraged::DriveAveraged(const systems::System& base) : _base(base) {
  core::require(base.structure().driven, "the mean over a drive wants a driven system");
}

VectorXd DriveAveraged::mean(std::size_t nodes, const double* z, const Values& values) const {
  const std::size_t last = static_cast<std::size_t>(dimension()) - 1;
  std::vector<double> state(z, z + (last + 1) * nodes);
  return mean_from(0, 1, [&](int n) {
    std::fill_n(state.begin() + static_cast<std::ptrdiff_t>(last * nodes), nodes, numerics::two_pi * n / drive_phases);
    return values(state.data());
  });
}

void DriveAveraged::field(std::size_t nodes, const double* z, double* f) const {
  const auto size = static_cast<Index>(static_cast<std::size_t>(dimension()) * nodes);
  Eigen::Map<VectorXd>(f, size) = mean(nodes, z, [&](const double* state) {
    VectorXd values(size);
    _base.field(nodes, state, values.data());
    return values;
  });
}

void DriveAveraged::field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const {
  const auto d = static_cast<std::size_t>(dimension());
  const auto size = static_cast<Index>(d * nodes);
  const Index both = size * static_cast<Index>(1 + d);
  const VectorXd values = mean(nodes, z, [&](const double* state) {
    VectorXd at(both);
    _base.field_jacobian(nodes, state, at.data(), at.data() + size);
    return at;
  });
  Eigen::Map<VectorXd>(f, size) = values.head(size);
  Eigen::Map<VectorXd>(jacobian, both - size) = values.tail(both - size);
  for (std::size_t i = 0; i < d; ++i) std::fill_n(jacobian + (i * d + d - 1) * nodes, nodes, 0.0);  // by the phase
}

void DriveAveraged::second_derivatives(std::size_t nodes, const double* z, const double* weights,
                                       double* contracted) const {
  const auto d = static_cast<std::size_t>(dimension());
  const auto size = static_cast<Index>(d * d * nodes);
  Eigen::Map<VectorXd>(contracted, size) = mean(nodes, z, [&](const double* state) {
    VectorXd values(size);
    _base.second_derivatives(nodes, state, weights, values.data());
    return values;
  });
  for (std::size_t l = 0; l < d; ++l) {
    std::fill_n(contracted + (l * d + d - 1) * nodes, nodes, 0.0);
    std::fill_n(contracted + ((d - 1) * d + l) * nodes, nodes, 0.0);
  }
}

Eigen::MatrixXd DriveAveraged::strength(const VectorXd& z) const {
  const Index d = z.size();
  VectorXd state = z;
  VectorXd values(d);
  RowMajor jacobian(d, d);
  RowMajor squares = RowMajor::Zero(d, d);
  for (int n = 0; n < drive_phases; ++n) {
    state(d - 1) = numerics::two_pi * n / drive_phases;
    _base.field_jacobian(1, state.data(), values.data(), jacobian.data());
    squares += jacobian.cwiseAbs2();
  }
  field_jacobian(1, z.data(), values.data(), jacobian.data());
  for (Index i = 0; i < d; ++i)
    for (Index l = 0; l + 1 < d; ++l)
      if (const double strong = std::sqrt(squares(i, l) / drive_phases); std::abs(jacobian(i, l)) < cancelled * strong)
        jacobian(i, l) = std::copysign(strong, jacobian(i, l));
  return jacobian;
}

VectorXd DriveAveraged::departure(const VectorXd& z) const {
  VectorXd average(z.size());
  field(1, z.data(), average.data());
  VectorXd largest = VectorXd::Zero(z.size());
  VectorXd state = z;
  VectorXd values(z.size());
  for (int n = 0; n < drive_phases; ++n) {
    state(z.size() - 1) = numerics::two_pi * n / drive_phases;
    _base.field(1, state.data(), values.data());
    largest = largest.cwiseMax((values - average).cwiseAbs());
  }
  return largest;
}

}  // namespace orbweaver::starts
