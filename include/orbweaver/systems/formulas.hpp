#pragma once

#include <map>
#include <string>
#include <vector>

#include "orbweaver/model/graph.hpp"

namespace orbweaver::systems {

/// A system's functions as the operations that they do, for arithmetics which its model is not compiled for. Lists are
/// nodes of the graph. Inputs 0 .. d - 1 are the state z, input d + i d + c the entry (i, c) of a matrix V.
struct Formulas {
  int dimension = 0;
  model::Graph graph;
  std::vector<int> field;                             ///< f(z)
  std::vector<int> variations;                        ///< df/dz V, entry (i, c) at i d + c
  std::vector<int> conserved;                         ///< one a conserved quantity
  std::vector<std::vector<int>> conserved_gradients;  ///< d nodes each
  std::vector<std::string> parameters;                ///< in the order of the graph's parameters
  std::vector<double> values;                         ///< theirs
};

/// A system that gives its formulas, in the units in which it is told. All registered systems do, scaled or not.
class FormulaSystem {
 public:
  virtual ~FormulaSystem() = default;
  FormulaSystem() = default;
  FormulaSystem(const FormulaSystem&) = delete;
  FormulaSystem& operator=(const FormulaSystem&) = delete;

  [[nodiscard]] virtual Formulas formulas() const = 0;
};

}  // namespace orbweaver::systems
