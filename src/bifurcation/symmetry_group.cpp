#include "symmetry_group.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double same_matrix = 1e-9;
constexpr double same_vector = 1e-3;  // kernel vectors are good to kernel_tolerance
constexpr std::size_t largest_group = 200;

struct Spatial {
  std::string name;
  bool reversing;
  int declared;
  Eigen::MatrixXd matrix;
};

// The identity, what the system declares, and all products.
std::vector<Spatial> spatial_group(const systems::Description& system) {
  const int d = system.dimension();
  std::vector<Spatial> group{{"1", false, -1, Eigen::MatrixXd::Identity(d, d)}};
  for (std::size_t n = 0; n < system.equivariances.size(); ++n)
    group.push_back({system.equivariances[n].name, false, static_cast<int>(n), system.equivariances[n].matrix});
  for (std::size_t n = 0; n < system.reversors.size(); ++n)
    group.push_back({system.reversors[n].name, true, static_cast<int>(n), system.reversors[n].matrix});
  const std::size_t generators = group.size();
  for (std::size_t n = 0; n < group.size(); ++n)
    for (std::size_t g = 1; g < generators; ++g) {
      const bool reversing = group[n].reversing != group[g].reversing;
      const Eigen::MatrixXd product = group[n].matrix * group[g].matrix;
      const bool known = std::any_of(group.begin(), group.end(), [&](const Spatial& s) {
        return s.reversing == reversing && (s.matrix - product).norm() < same_matrix;
      });
      if (known) continue;
      core::require(group.size() < largest_group, "the declared symmetries of a system must generate a finite group");
      const std::size_t unnamed = reversing ? system.reversors.size() : system.equivariances.size();
      group.push_back({group[n].name + group[g].name, reversing, static_cast<int>(unnamed), product});
    }
  return group;
}

int order_of(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd power = matrix;
  int order = 1;
  while (!power.isIdentity(same_matrix)) {
    power *= matrix;
    ++order;
  }
  return order;
}

// Shifts of symmetries are multiples of T/m over the order of their matrix (and of quarters, as in isotropies), the loop
// being an orbit m times around.
int shared_order(const std::vector<Spatial>& group) {
  int order = 4;
  for (const Spatial& s : group) order = std::lcm(order, order_of(s.matrix));
  return order;
}

// m: the greatest common divisor of the harmonics (and windings) that the loop has; 0 for a constant loop.
int repetitions(const loop::Loop& loop, double tolerance) {
  int divisor = 0;
  for (int k = 1; k <= loop.cutoff; ++k) {
    double weight = 0.0;
    for (int i = 0; i < loop.dimension; ++i)
      weight = std::max({weight, std::abs(loop.cosine(k, i)), std::abs(loop.sine(k, i))});
    if (weight > tolerance) divisor = std::gcd(divisor, k);
  }
  for (const double n : loop.winding) divisor = std::gcd(divisor, static_cast<int>(std::lround(n)));
  return divisor;
}

}  // namespace

bool Action::maps(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  return (matrix * from - to).norm() < same_vector;
}

SymmetryGroup::SymmetryGroup(const systems::Description& system, const loop::Loop& base,
                             const std::vector<loop::Tangent>& kernel, const DirectionOptions& options) {
  const auto n = static_cast<Eigen::Index>(kernel.size());
  _kernel.resize(static_cast<Eigen::Index>(base.modes.size()), n);
  std::vector<loop::Loop> vectors;
  for (Eigen::Index c = 0; c < n; ++c) {
    const loop::Tangent& v = kernel[static_cast<std::size_t>(c)];
    core::require(v.modes.size() == base.modes.size(), "kernel vectors need the size of the base loop's modes");
    _kernel.col(c) = Eigen::Map<const Eigen::VectorXd>(v.modes.data(), _kernel.rows());
    vectors.push_back(loop::perturbation(base, v));
  }
  core::require((_kernel.transpose() * _kernel - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-6,
                "kernel vectors must be orthonormal");
  const int times = repetitions(base, options.symmetry_tolerance);
  _constant = times == 0;
  if (_constant)
    for (const loop::Loop& v : vectors)
      core::require(
          repetitions(v, 1e-9) == 1 && loop::rms_amplitude(loop::with_cutoff(v, 1)) > (1.0 - 1e-9) / std::sqrt(2.0),
          "kernel vectors of an equilibrium must be of harmonic 1");

  const std::vector<Spatial> spatial = spatial_group(system);
  _denominator = shared_order(spatial) * std::max(times, 1);
  for (const Spatial& s : spatial)
    for (int shift = 0; shift < _denominator; ++shift) {
      const int divisor = std::gcd(shift, _denominator);
      const loop::SymmetryElement element{s.name, s.reversing, s.matrix, shift / divisor, _denominator / divisor};
      if (loop::symmetry_defect(base, element, system.angles) > options.symmetry_tolerance) continue;
      Eigen::MatrixXd images(_kernel.rows(), n);
      for (Eigen::Index c = 0; c < n; ++c) {
        const loop::Loop image = loop::transformed(vectors[static_cast<std::size_t>(c)], element);
        images.col(c) = Eigen::Map<const Eigen::VectorXd>(image.modes.data(), _kernel.rows());
      }
      const Eigen::MatrixXd action = _kernel.transpose() * images;
      const double gap = (images - _kernel * action).norm();
      const double skew = (action.transpose() * action - Eigen::MatrixXd::Identity(n, n)).norm();
      if (std::max(gap, skew) > options.kernel_tolerance)
        throw core::NumericalError(
            fmt::format("the symmetry {} of the orbit does not map its kernel (dimension {}) to itself: off by {:.2g}, "
                        "isometric to {:.2g}; the kernel is incomplete, inaccurate or not transverse to the time shift",
                        loop::to_text({element}), n, gap, skew));
      _actions.push_back({element, s.declared, action});
      if (_constant && s.declared < 0 && 4 * shift == _denominator) _quarter = action;
    }
}

loop::Tangent SymmetryGroup::vector_at(const Eigen::VectorXd& coordinates) const {
  const Eigen::VectorXd v = _kernel * coordinates;
  return {{v.begin(), v.end()}, {}};
}

Eigen::VectorXd SymmetryGroup::coordinates_of(std::span<const double> modes) const {
  // `modes` may have more harmonics than the kernel.
  return _kernel.transpose() * Eigen::Map<const Eigen::VectorXd>(modes.data(), _kernel.rows());
}

int SymmetryGroup::image(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double tolerance) const {
  const double least = 1.0 - 0.5 * tolerance * tolerance;
  bool opposite = false;
  for (const Action& action : _actions) {
    const Eigen::VectorXd moved = action.matrix * from;
    const double along = to.dot(moved);
    // A constant loop may be shifted by any time: compared are the complex amplitudes.
    const double overlap = _constant ? std::hypot(along, to.dot(_quarter * moved)) : along;
    if (overlap > least) return 1;
    if (overlap < -least) opposite = true;
  }
  return opposite ? -1 : 0;
}

}  // namespace orbweaver::bifurcation
