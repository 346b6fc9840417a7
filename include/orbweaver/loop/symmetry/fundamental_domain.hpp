#pragma once

#include <optional>

#include <Eigen/Dense>

#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::loop {

/// The part of a loop that its isotropy repeats: s in [0, 2 pi / order], with z(t + T/order) = generator z(t); or half
/// of that where a reversor z(-t) = R z(t) mirrors it (both ends then lie on fixed sets).
struct FundamentalDomain {
  int order = 1;                            ///< p
  Eigen::MatrixXd generator;                ///< dimension x dimension
  std::optional<Eigen::MatrixXd> reversor;  ///< R of shift 0
  /// Onto the states that all equivariances of shift 0 keep, in which such a loop lies; none where there are none.
  std::optional<Eigen::MatrixXd> projection;

  [[nodiscard]] int dimension() const { return static_cast<int>(generator.rows()); }
  /// How many copies of the domain make the loop.
  [[nodiscard]] int copies() const { return reversor ? 2 * order : order; }
  /// What holds between perturbations at both ends: left z(0) + right z(end) = 0, one condition a row.
  struct Ends {
    Eigen::MatrixXd left;
    Eigen::MatrixXd right;
  };
  /// z(end) = generator z(0), or z(0) in Fix(R) and z(end) in Fix(generator R).
  [[nodiscard]] Ends ends() const;
  /// True if every element of `isotropy` acts on the states that the projection keeps as a product of the generator and
  /// the reversor: the domain then has all of it.
  [[nodiscard]] bool expresses(const Isotropy& isotropy) const;
  /// False for coordinates whose mean over the loop the symmetries make zero (relative to a point that they keep).
  [[nodiscard]] std::vector<bool> coordinates_with_mean() const;
  /// True if there are as many end conditions as coordinates: the domain is then a boundary value problem.
  [[nodiscard]] bool is_square() const;
};

/// The domain of the group that `isotropy` generates; reversors with another shift than 0 are not used. What stands on
/// it is relative to a point that the symmetries map to itself, so that only their matrices are needed.
[[nodiscard]] FundamentalDomain fundamental_domain(const systems::Structure& structure, const Isotropy& isotropy);

}  // namespace orbweaver::loop
