#include "reach.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace orbweaver::cost {

namespace {
constexpr double none = std::numeric_limits<double>::quiet_NaN();
}

const std::vector<double>& Reach::targets() {
  static const std::vector<double> values{1e-3, 1e-6, 1e-9, 1e-12};
  return values;
}

void Reach::add(double seconds, double error) {
  if (_least.empty()) {
    _least.assign(targets().size(), none);
    _best = none;
  }
  _best = std::fmin(_best, error);
  for (std::size_t n = 0; n < _least.size(); ++n)
    if (error <= targets()[n]) _least[n] = std::fmin(_least[n], seconds);
}

std::vector<Column> Reach::columns() {
  std::vector<Column> columns;
  for (const double target : targets()) columns.push_back({fmt::format("to {:.0e}", target), "s"});
  columns.push_back({"best error"});
  return columns;
}

std::vector<Cell> Reach::cells() const {
  if (_least.empty()) return std::vector<Cell>(targets().size() + 1);
  std::vector<Cell> cells(_least.begin(), _least.end());
  cells.emplace_back(_best);
  return cells;
}

}  // namespace orbweaver::cost
