#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

/// Loops about an equilibrium whose part in a kernel is given, and which satisfy the system's equation but for a force
/// along it (Lyapunov-Schmidt reduction, on the harmonics of a constant loop).
class LyapunovSchmidt {
 public:
  /// `base`: the constant loop, with the period that the oscillations share. Loops have `order` times the kernel's
  /// highest harmonic. All three must outlive this.
  LyapunovSchmidt(const systems::System& system, const loop::Loop& base, const KernelActions& group, int order);

  /// How many times each oscillation goes around in the period.
  [[nodiscard]] const Eigen::VectorXd& around() const { return _around; }

  /// Amplitudes of the oscillations, and back.
  [[nodiscard]] Eigen::VectorXcd amplitudes(const Eigen::VectorXd& coordinates) const {
    return _in_kernel * coordinates;
  }
  [[nodiscard]] Eigen::VectorXd coordinates(const Eigen::VectorXcd& amplitudes) const;

  /// Nothing where no loop is found, or the field has no value.
  [[nodiscard]] std::optional<Eigen::VectorXcd> force(const Eigen::VectorXcd& amplitudes) const;

 private:
  /// Of one harmonic: the linear equation, bordered by the kernel's vectors of it.
  struct Solver {
    Eigen::MatrixXcd matrix;
    std::vector<Eigen::Index> members;
    Eigen::JacobiSVD<Eigen::MatrixXcd> factor{};
  };

  void linearize(int order);
  /// Of f at the loop with harmonics `u` about the point: what is not linear in it.
  [[nodiscard]] Eigen::MatrixXcd nonlinear(const Eigen::MatrixXcd& u) const;

  const systems::System& _system;
  const loop::Loop& _base;
  const KernelActions& _group;
  Eigen::Index _d;
  std::vector<double> _point;
  Eigen::MatrixXcd _vectors;    // of the kernel's coordinates
  Eigen::MatrixXcd _basis;      // of the oscillations: those of one harmonic are orthonormal
  Eigen::MatrixXcd _in_kernel;  // oscillations x coordinates
  Eigen::VectorXd _around;
  Eigen::MatrixXd _jacobian;
  std::vector<Solver> _solvers;  // of harmonics 0, 1, ...
  Eigen::MatrixXcd _waves;
};

}  // namespace orbweaver::bifurcation
