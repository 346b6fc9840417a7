#pragma once

#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::equations {

/// The LU factors of a square matrix that is given by its products: O(n) products and O(n^3) for n entries in use.
class DenseFactor {
 public:
  using Product = std::function<void(const double* v, double* r)>;
  /// Of vectors of `size` numbers, those at `entries` are in use; the product leaves the others out.
  DenseFactor(int size, std::vector<int> entries, const Product& product);
  /// r <- the solution for the right-hand side r; entries that are not in use become 0.
  void solve(double* r) const;

 private:
  int _size;
  std::vector<int> _entries;
  Eigen::PartialPivLU<Eigen::MatrixXd> _factors;
};

}  // namespace orbweaver::equations
