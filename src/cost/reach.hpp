#pragma once

#include <string>
#include <vector>

#include "orbweaver/cost/table.hpp"

namespace orbweaver::cost {

/// The true errors at which ways to an orbit are compared, and the least time in which one gets there.
class Reach {
 public:
  static const std::vector<double>& targets();

  void add(double seconds, double error);

  /// "to 1e-03" ... "best error": the heads of `cells`.
  [[nodiscard]] static std::vector<Column> columns();
  [[nodiscard]] std::vector<Cell> cells() const;

 private:
  std::vector<double> _least;  // one a target; empty: nothing added
  double _best = 0.0;
};

}  // namespace orbweaver::cost
