#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A sum w . z of the coordinates that a system without a symplectic form conserves, whatever its state: atoms in a
/// network of reactions, a population. Nothing moves with it as coordinates do with a momentum.
struct LinearTotal {
  std::string name;
  Eigen::VectorXd weights;  ///< w; 0 for angles
  int quantity = -1;        ///< the one of structure().conserved that it is; -1: the structure does not name it
};

/// All linear totals of a dissipative system, or of one that names nothing that it conserves; none of another, and
/// none where fewer than two coordinates would be left. The weights are what the field and its Jacobian annul from the
/// left at some eighty states, first in double and then, if anything is left, in quadruple precision: a slow reaction
/// that breaks a total beside a fast one is seen. Those that the structure names come first and as it has them; the
/// others have the first of their coordinates in no other, with the weight 1, and are called after it: "total_X1".
[[nodiscard]] std::vector<LinearTotal> linear_totals(const System& system);

/// "X1 + 2 X2".
[[nodiscard]] std::string sum_text(const std::vector<std::string>& names, const Eigen::VectorXd& weights);

}  // namespace orbweaver::systems
