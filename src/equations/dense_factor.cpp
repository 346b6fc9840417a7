#include "dense_factor.hpp"

#include <algorithm>
#include <utility>

namespace orbweaver::equations {

DenseFactor::DenseFactor(int size, std::vector<int> entries, const Product& product)
    : _size(size), _entries(std::move(entries)) {
  const auto n = static_cast<Eigen::Index>(_entries.size());
  Eigen::MatrixXd matrix(n, n);
  std::vector<double> unit(static_cast<std::size_t>(size), 0.0);
  std::vector<double> column(unit.size());
  for (Eigen::Index c = 0; c < n; ++c) {
    double& one = unit[static_cast<std::size_t>(_entries[static_cast<std::size_t>(c)])];
    one = 1.0;
    product(unit.data(), column.data());
    one = 0.0;
    for (Eigen::Index r = 0; r < n; ++r)
      matrix(r, c) = column[static_cast<std::size_t>(_entries[static_cast<std::size_t>(r)])];
  }
  _factors.compute(matrix);
}

void DenseFactor::solve(double* r) const {
  Eigen::VectorXd side(static_cast<Eigen::Index>(_entries.size()));
  for (Eigen::Index n = 0; n < side.size(); ++n) side(n) = r[_entries[static_cast<std::size_t>(n)]];
  side = _factors.solve(side).eval();
  std::fill_n(r, _size, 0.0);
  for (Eigen::Index n = 0; n < side.size(); ++n) r[_entries[static_cast<std::size_t>(n)]] = side(n);
}

}  // namespace orbweaver::equations
