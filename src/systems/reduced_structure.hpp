#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "linear_quantities.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A ratio of small whole numbers, of which any arithmetic has all digits.
struct Ratio {
  int numerator = 0;
  int denominator = 1;
};

/// y -> S y with S = diag(sqrt(squares)) unit, unit being upper triangular with ones in its diagonal.
struct Straightening {
  std::vector<Ratio> squares;
  std::vector<std::vector<Ratio>> unit;
};

/// The coordinates y of a reduced system, n of the whole system's d: z = states y + origin has the values that are held
/// and the coordinates `frame` at 0, and dy/dt = rates dz/dt, which is blind to the motions.
struct Chart {
  std::vector<std::size_t> kept;  ///< the whole system's coordinates, told from the frame, are x_c = z_kept[c]
  std::optional<Straightening> straightening;  ///< y = S x; y = x without it
  std::vector<int> others;                     ///< the conserved quantities that are left
  Eigen::VectorXd values;                      ///< of the linear quantities (k), held
  Eigen::VectorXd constants;                   ///< theirs at z = 0
  Eigen::MatrixXd gradients;                   ///< theirs, d x k
  Eigen::MatrixXd from_values;                 ///< of the redundant coordinates by the values, k x k
  Eigen::MatrixXd states;                      ///< d x n
  Eigen::VectorXd origin;                      ///< d
  Eigen::MatrixXd rates;                       ///< n x d
};

/// What a reduced system is of.
struct Reduction {
  std::shared_ptr<const System> whole;
  LinearQuantities linear;
  Chart chart;
};

[[nodiscard]] Chart chart_of(const System& whole, const LinearQuantities& linear,
                             const std::optional<Straightening>& straightening);

/// Of symmetries that have orthogonal matrices on the whole system, how far those on the reduced one are from it: all
/// that measures loops takes symmetries for isometries.
[[nodiscard]] double skewness(const System& whole, const LinearQuantities& linear, const Chart& chart);

/// That of the length which orthogonal symmetries of the whole system keep, if its entries are ratios, and it leaves
/// angles alone. `chart` is one without.
[[nodiscard]] std::optional<Straightening> straightening_of(const System& whole, const LinearQuantities& linear,
                                                            const Chart& chart);

/// Symmetries are those of the whole system that map motions to motions and keep the values that are held, without what
/// then is the identity, named twice or skew; of those that do not, products of two that do are added.
[[nodiscard]] Structure reduced_structure(const System& whole, const LinearQuantities& linear, const Chart& chart);

[[nodiscard]] ModelInfo reduced_info(const System& whole, const LinearQuantities& linear, const Chart& chart);

}  // namespace orbweaver::systems
