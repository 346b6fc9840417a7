#pragma once

#include <vector>

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

struct ReducedZeros {
  std::vector<Eigen::VectorXd> vectors;  ///< of unit length, one for each that no symmetry maps to another
  /// None is missing, and each is isolated: every start leads to one of them, the force changes beside each by more
  /// than the fit leaves, and their indices, those of images counted and each divided by the times that it goes around
  /// its own period, add up to the sum of 1/k over the oscillations, the Euler characteristic of the space of unit
  /// vectors, time shifts aside (an orbifold).
  bool is_complete = false;
};

/// The kernel vectors near which families leave an equilibrium where several oscillations share its period, as a
/// polynomial says.
///
/// In complex amplitudes a the force of LyapunovSchmidt commutes with shifts of time, a_m -> e^{i k_m t} a_m: it is a
/// sum of products of a and conj(a) that do. The coefficients of those up to some order are fitted. Where the force
/// only turns a, a family leaves, with another period. These zeros cost so little that they are sought from many
/// starts.
[[nodiscard]] ReducedZeros reduced_zeros(const systems::System& system, const loop::Loop& base,
                                         const KernelActions& group, double amplitude);

}  // namespace orbweaver::bifurcation
