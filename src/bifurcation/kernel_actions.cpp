#include "kernel_actions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "fixed_spaces.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Kernel vectors are orthonormal and oscillations about an equilibrium of one harmonic to this, or the caller is
/// wrong.
constexpr double orthonormal = 1e-6;
constexpr double pure_oscillation = 1e-9;

constexpr double same_vector = 1e-3;  // kernel vectors are good to kernel_tolerance

/// Time shifts at which an overlap of vectors is looked at first, per harmonic: between them its maximum is found by
/// Newton's method in as many steps.
constexpr int shifts_a_harmonic = 12;
constexpr int newton_steps = 5;

/// A kernel that misses a vector, or has a wrong one, is off by a number of order 1 under the symmetries of its orbit;
/// one that is off by less is the right one, and rounding has its digits.
constexpr double wrong_kernel = 0.05;

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
int divisor_of_harmonics(const loop::Loop& loop, double tolerance) {
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

/// The harmonic of a kernel vector of an equilibrium.
int harmonic_of(const loop::Loop& vector) {
  int harmonic = 0;
  double largest = 0.0;
  double all = 0.0;
  for (int k = 0; k <= vector.cutoff; ++k) {
    double square = 0.0;
    for (int i = 0; i < vector.dimension; ++i)
      square += vector.cosine(k, i) * vector.cosine(k, i) + (k > 0 ? vector.sine(k, i) * vector.sine(k, i) : 0.0);
    all += square;
    if (square > largest) {
      largest = square;
      harmonic = k;
    }
  }
  core::require(harmonic > 0 && std::sqrt(all - largest) < pure_oscillation * std::sqrt(all),
                "kernel vectors of an equilibrium must be of one harmonic");
  return harmonic;
}

/// d/ds.
loop::Loop derivative(loop::Loop loop) {
  for (int i = 0; i < loop.dimension; ++i) {
    loop.cosine(0, i) = 0.0;
    for (int k = 1; k <= loop.cutoff; ++k) {
      const double cosine = loop.cosine(k, i);
      loop.cosine(k, i) = k * loop.sine(k, i);
      loop.sine(k, i) = -k * cosine;
    }
  }
  return loop;
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
  _times = divisor_of_harmonics(base, options.symmetry_tolerance);
  _constant = _times == 0;
  const loop::Isotropy spatial = loop::SymmetryGroup::of_space(system).elements();
  _denominator = shared_order(spatial, system.angles) * std::max(_times, 1);
  if (_constant) {
    Eigen::MatrixXd turned(_kernel.rows(), n);
    int shared_harmonics = 1;
    for (Eigen::Index c = 0; c < n; ++c) {
      const loop::Loop& v = vectors[static_cast<std::size_t>(c)];
      _harmonics.push_back(harmonic_of(v));
      shared_harmonics = std::lcm(shared_harmonics, _harmonics.back());
      turned.col(c) = Eigen::Map<const Eigen::VectorXd>(derivative(v).modes.data(), _kernel.rows());
    }
    _turn = _kernel.transpose() * turned;
    _denominator *= shared_harmonics;
  }
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
      const double off = std::max(gap, skew);
      const auto text = [&](const char* why) {
        return fmt::format(
            "the symmetry {} of the orbit does not map its kernel (dimension {}) to itself: off by {:.2g}, isometric "
            "to {:.2g}; {}",
            loop::to_text({element}), n, gap, skew, why);
      };
      if (off > wrong_kernel)
        throw core::NumericalError(text("the kernel is incomplete, or not transverse to the time shift"));
      if (off > options.kernel_tolerance) throw UndecidedError(text("the kernel is known no better"));
      _actions.push_back({element, declared, action});
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

/// A constant loop may be shifted by any time phi: the part of harmonic k of the overlap is a cos k phi + b sin k phi.
double KernelActions::largest_overlap(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  const int highest = *std::max_element(_harmonics.begin(), _harmonics.end());
  std::vector<double> a(static_cast<std::size_t>(highest) + 1, 0.0);
  std::vector<double> b(a);
  const Eigen::VectorXd turned = _turn * from;
  for (std::size_t c = 0; c < _harmonics.size(); ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    const auto k = static_cast<std::size_t>(_harmonics[c]);
    a[k] += to(at) * from(at);
    b[k] += to(at) * turned(at) / _harmonics[c];
  }
  if (std::count(_harmonics.begin(), _harmonics.end(), highest) == dimension()) return std::hypot(a.back(), b.back());
  const auto at = [&](double phi, int order) {  // a derivative
    double sum = 0.0;
    for (std::size_t k = 1; k < a.size(); ++k) {
      const double angle = static_cast<double>(k) * phi + 0.5 * std::numbers::pi * order;
      sum += std::pow(k, order) * (a[k] * std::cos(angle) + b[k] * std::sin(angle));
    }
    return sum;
  };
  double largest = -1.0;
  double phi = 0.0;
  for (int n = 0; n < shifts_a_harmonic * highest; ++n) {
    const double here = 2.0 * std::numbers::pi * n / (shifts_a_harmonic * highest);
    if (const double overlap = at(here, 0); overlap > largest) {
      largest = overlap;
      phi = here;
    }
  }
  for (int n = 0; n < newton_steps && at(phi, 2) < 0.0; ++n) phi -= at(phi, 1) / at(phi, 2);
  return std::max(largest, at(phi, 0));
}

int KernelActions::image(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double tolerance) const {
  const double least = 1.0 - 0.5 * tolerance * tolerance;
  bool opposite = false;
  for (const Action& action : _actions) {
    const Eigen::VectorXd moved = action.matrix * from;
    const double overlap = _constant ? largest_overlap(moved, to) : to.dot(moved);
    if (overlap > least) return 1;
    if (!_constant && overlap < -least) opposite = true;
  }
  return opposite ? -1 : 0;
}

int KernelActions::rotations() const {
  std::vector<Eigen::MatrixXd> distinct;
  for (const Action& a : _actions)
    if (a.matrix.determinant() > 0.0 && std::none_of(distinct.begin(), distinct.end(), [&](const Eigen::MatrixXd& m) {
          return (m - a.matrix).norm() < same_element;
        }))
      distinct.push_back(a.matrix);
  return static_cast<int>(distinct.size());
}

int KernelActions::images(const Eigen::VectorXd& of, double tolerance) const {
  const double least = 1.0 - 0.5 * tolerance * tolerance;
  std::vector<Eigen::VectorXd> distinct;
  for (const Action& action : _actions) {
    const Eigen::VectorXd moved = action.matrix * of;
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const Eigen::VectorXd& known) { return largest_overlap(moved, known) > least; }))
      distinct.push_back(moved);
  }
  return static_cast<int>(distinct.size());
}

int KernelActions::times_around(const Eigen::VectorXd& of, double tolerance) const {
  int divisor = 0;
  for (std::size_t c = 0; c < _harmonics.size(); ++c)
    if (std::abs(of(static_cast<Eigen::Index>(c))) > tolerance) divisor = std::gcd(divisor, _harmonics[c]);
  return std::max(divisor, 1);
}

}  // namespace orbweaver::bifurcation
