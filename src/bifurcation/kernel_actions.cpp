#include "kernel_actions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Kernel vectors are orthonormal and an oscillation about an equilibrium is of harmonic 1 to this, or the caller is
/// wrong.
constexpr double orthonormal = 1e-6;
constexpr double pure_oscillation = 1e-9;

constexpr double same_vector = 1e-3;  // kernel vectors are good to kernel_tolerance

// The element's place among the system's equivariances or reversors; -1: the identity; their number: a product of some.
int declared_place(const systems::Structure& structure, const loop::SymmetryElement& element) {
  if (!element.reversing && element.name == "1") return -1;
  const auto& list = element.reversing ? structure.reversors : structure.equivariances;
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const systems::Symmetry& s) { return s.name == element.name; });
  return static_cast<int>(found - list.begin());
}

int order_of(const systems::AffineMap& map, const std::vector<int>& angles) {
  const auto identity = systems::AffineMap::identity(map.dimension());
  systems::AffineMap power = map;
  int order = 1;
  while (!power.is_same(identity, angles)) {
    power = power * map;
    ++order;
  }
  return order;
}

// Shifts of symmetries are multiples of T/m over the order of their matrix (and of quarters, as in isotropies), the
// loop being an orbit m times around.
int shared_order(const loop::Isotropy& group, const std::vector<int>& angles) {
  int order = 4;
  for (const loop::SymmetryElement& s : group) order = std::lcm(order, order_of(s.map, angles));
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

KernelActions::KernelActions(const systems::Structure& system, const loop::Loop& base,
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
  core::require((_kernel.transpose() * _kernel - Eigen::MatrixXd::Identity(n, n)).norm() < orthonormal,
                "kernel vectors must be orthonormal");
  const int times = repetitions(base, options.symmetry_tolerance);
  _constant = times == 0;
  if (_constant)
    for (const loop::Loop& v : vectors)
      core::require(repetitions(v, pure_oscillation) == 1 &&
                        loop::rms_amplitude(loop::with_cutoff(v, 1)) > (1.0 - pure_oscillation) / std::sqrt(2.0),
                    "kernel vectors of an equilibrium must be of harmonic 1");

  const loop::Isotropy spatial = loop::SymmetryGroup::of_space(system).elements();
  _denominator = shared_order(spatial, system.angles) * std::max(times, 1);
  for (const loop::SymmetryElement& s : spatial)
    for (int shift = 0; shift < _denominator; ++shift) {
      const int divisor = std::gcd(shift, _denominator);
      const loop::SymmetryElement element{s.name, s.reversing, s.map, shift / divisor, _denominator / divisor};
      if (loop::symmetry_defect(base, element, system.angles) > options.symmetry_tolerance) continue;
      Eigen::MatrixXd images(_kernel.rows(), n);
      for (Eigen::Index c = 0; c < n; ++c) {
        const loop::Loop image = loop::transformed_perturbation(vectors[static_cast<std::size_t>(c)], element);
        images.col(c) = Eigen::Map<const Eigen::VectorXd>(image.modes.data(), _kernel.rows());
      }
      const int declared = declared_place(system, s);
      const Eigen::MatrixXd action = _kernel.transpose() * images;
      const double gap = (images - _kernel * action).norm();
      const double skew = (action.transpose() * action - Eigen::MatrixXd::Identity(n, n)).norm();
      if (std::max(gap, skew) > options.kernel_tolerance)
        throw core::NumericalError(
            fmt::format("the symmetry {} of the orbit does not map its kernel (dimension {}) to itself: off by {:.2g}, "
                        "isometric to {:.2g}; the kernel is incomplete, inaccurate or not transverse to the time shift",
                        loop::to_text({element}), n, gap, skew));
      _actions.push_back({element, declared, action});
      if (_constant && declared < 0 && 4 * shift == _denominator) _quarter = action;
    }
}

loop::Tangent KernelActions::vector_at(const Eigen::VectorXd& coordinates) const {
  const Eigen::VectorXd v = _kernel * coordinates;
  return {{v.begin(), v.end()}, {}};
}

Eigen::VectorXd KernelActions::coordinates_of(std::span<const double> modes) const {
  // `modes` may have more harmonics than the kernel.
  return _kernel.transpose() * Eigen::Map<const Eigen::VectorXd>(modes.data(), _kernel.rows());
}

int KernelActions::image(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double tolerance) const {
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
