#pragma once

#include <vector>

#include <Eigen/Dense>

#include "orbweaver/bifurcation/directions.hpp"

namespace orbweaver::bifurcation {

/// Radians: distinct lines of a finite group are much further apart.
inline constexpr double same_line = 3e-3;

/// A symmetry of the base loop and its orthogonal matrix in the kernel's coordinates.
struct Action {
  loop::SymmetryElement element;
  int declared;  ///< place in the system's equivariances or reversors; -1: the identity; their number: a product
  Eigen::MatrixXd matrix;

  [[nodiscard]] bool maps(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
};

/// All spatio-temporal symmetries of a loop, and how they act on a kernel: the group that the declared symmetries
/// generate with the time shifts that the loop allows. A constant loop allows every shift: the actions then hold a
/// finite part of these, and comparisons all of them.
class KernelActions {
 public:
  KernelActions(const systems::Structure& system, const loop::Loop& base, const std::vector<loop::Tangent>& kernel,
                const DirectionOptions& options);

  [[nodiscard]] const std::vector<Action>& actions() const { return _actions; }
  [[nodiscard]] bool constant() const { return _constant; }
  [[nodiscard]] int dimension() const { return static_cast<int>(_kernel.cols()); }
  /// How many times the loop goes around its orbit.
  [[nodiscard]] int times() const { return _times; }
  /// The denominator that all shifts share.
  [[nodiscard]] int denominator() const { return _denominator; }
  /// How many of a plane's symmetries are rotations: q of the sector e^{2 pi i j / q}.
  [[nodiscard]] int rotations() const;
  /// How the coordinates change with a time shift, per radian of s, for constant loops: skew.
  [[nodiscard]] const Eigen::MatrixXd& turn() const { return _turn; }
  /// The kernel vector with these coordinates, and back.
  [[nodiscard]] loop::Tangent vector_at(const Eigen::VectorXd& coordinates) const;
  [[nodiscard]] Eigen::VectorXd coordinates_of(std::span<const double> modes) const;
  /// +1 if a symmetry maps `from` to `to`, -1 if only to -`to`, 0 if neither; unit vectors, as far apart as
  /// `tolerance`. For constant loops, whose two sides are different directions, not -1.
  [[nodiscard]] int image(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double tolerance) const;
  /// For constant loops: how many images of a unit vector time shifts do not map to one another, as far apart as
  /// `tolerance`; and how many times it goes around its own period.
  [[nodiscard]] int images(const Eigen::VectorXd& of, double tolerance) const;
  [[nodiscard]] int times_around(const Eigen::VectorXd& of, double tolerance) const;

 private:
  [[nodiscard]] double largest_overlap(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

  Eigen::MatrixXd _kernel;  // modes x dimension
  std::vector<Action> _actions;
  std::vector<int> _harmonics;  // of the kernel's vectors, for constant loops
  Eigen::MatrixXd _turn;
  bool _constant = false;
  int _times = 1;
  int _denominator = 1;
};

}  // namespace orbweaver::bifurcation
