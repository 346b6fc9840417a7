#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// The conserved quantities of a system that are linear in its coordinates, Q_a = w_a . z + constant, and the
/// translations that belong to them: all v with f(z + v) = f(z). Totals (LinearTotal) have none.
struct LinearQuantities {
  std::vector<int> quantities;  ///< which of the structure's
  Eigen::MatrixXd motions;      ///< one a column, whole numbers; the identity in the rows `frame`
  std::vector<int> frame;       ///< coordinates that the motions bring to 0, one a motion
  std::vector<int> redundant;   ///< coordinates that follow from the others and the quantities' values, one a quantity
  std::vector<double> place;    ///< a state where the field is finite
};

struct LinearSearch {
  LinearQuantities found;
  std::vector<LinearQuantities> frames;      ///< `found` with each `frame` (and its motions) that will do, itself first
  std::vector<std::vector<int>> redundants;  ///< each `redundant` that will do with the first frame, itself first
  std::string obstacle;                      ///< why they cannot be divided out, empty where they can
};

/// Finds them from the field and the gradients at some forty states.
[[nodiscard]] LinearSearch find_linear_quantities(const System& system);

[[nodiscard]] Eigen::MatrixXd rows_of(const Eigen::MatrixXd& matrix, const std::vector<int>& rows);

/// The gradients of the quantities at `place`, one a column.
[[nodiscard]] Eigen::MatrixXd gradients_of(const System& system, const std::vector<int>& quantities,
                                           const std::vector<double>& place);

}  // namespace orbweaver::systems
