#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "kernel_actions.hpp"

namespace orbweaver::bifurcation {

/// What a symmetry of an orbit found may be off, in parts of its amplitude: a broken one is off by all of it.
inline constexpr double found_tolerance = 1e-2;

/// An orbit off the base loop and the unit kernel coordinates in which it leaves.
struct FoundOrbit {
  Eigen::VectorXd coordinates;
  double along = 0.0;  ///< how far it lies along the base's own family, in parts of its length in the kernel
  loop::Loop loop;
  std::optional<loop::Loop> opposite{};  ///< one that lies to the other side, where that was looked for
};

/// Where an orbit near `base` lies from it.
struct Gap {
  Eigen::VectorXd inside;  ///< kernel coordinates
  double along = 0.0;      ///< along the base's own family, whose unit direction is `family` (modes; may be empty)
  double beside = 0.0;     ///< length of what lies in neither
};
[[nodiscard]] Gap gap_between(const loop::Loop& base, const loop::Loop& orbit, const KernelActions& group,
                              const std::vector<double>& family);

struct SearchResult {
  std::vector<FoundOrbit> found;
  int not_isolated = 0;  ///< orbits whose direction may be changed a little and then stays: not among `found`
  int lost = 0;          ///< starts that led to none of these, nor to one known
};

/// Orbits near `base`, or near the family that it lies on, whose part in the kernel has the length `amplitude`, one for
/// each that no symmetry of `group` maps to another or to one of `known` (to its negative neither): Newton's method
/// from the kernel directions `starts` and, in a plane and if `partner` is not 0, from that angle beside each one
/// found: extrema of the reduced action alternate, and one kind of them may be reached from very near only. Each is
/// sought once more from `nudge` radians beside it, and, if `are_isolated` says that they are, where that leads away,
/// among those with its symmetries.
[[nodiscard]] SearchResult search_directions(const systems::System& system, const loop::Loop& base,
                                             const KernelActions& group, const loop::Isotropy& isotropy,
                                             std::vector<Eigen::VectorXd> starts, double partner, double amplitude,
                                             double nudge, const std::vector<Eigen::VectorXd>& known,
                                             const DirectionOptions& options, bool are_isolated = false);

/// Whether an orbit found about an equilibrium is of a family that is born on one of the directions `known` further out
/// than the given amplitude: followed towards them, its part in the kernel keeps a greater length. Also false where it
/// cannot be followed.
[[nodiscard]] bool is_born_beyond(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                                  const loop::Isotropy& isotropy, loop::Loop orbit, double amplitude,
                                  const std::vector<Eigen::VectorXd>& known, const DirectionOptions& options);

/// Unit vectors: evenly over the angles [0, 2 pi / order) of a plane, or from a Halton sequence on a sphere of more
/// dimensions (four times as many in three, doubling with each).
[[nodiscard]] std::vector<Eigen::VectorXd> start_directions(int dimension, int order, int count);

}  // namespace orbweaver::bifurcation
