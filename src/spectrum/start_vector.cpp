#include "start_vector.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::spectrum {

core::Handle<Vec> start_vector(int size) {
  core::Handle<Vec> vector = loss::create_vector(size);
  Eigen::VectorXd values(size);
  // Quasi-random and without symmetry, so that no eigenvector is orthogonal to it by accident.
  for (int n = 0; n < size; ++n) values(n) = 0.5 + std::fmod(0.6180339887498949 * (n + 1), 1.0);
  loss::assign(vector.get(), values);
  return vector;
}

void seed_basis(BV basis) {
  core::Handle<PetscRandom> random;
  core::check(PetscRandomCreate(PETSC_COMM_SELF, random.put()), "PetscRandomCreate");
  core::check(PetscRandomSetSeed(random.get(), 20240607), "PetscRandomSetSeed");
  core::check(PetscRandomSeed(random.get()), "PetscRandomSeed");
  core::check(BVSetRandomContext(basis, random.get()), "BVSetRandomContext");
}

Eigen::VectorXd with_fixed_sign(const Eigen::VectorXd& vector) {
  const double largest = vector.cwiseAbs().maxCoeff();
  for (const double entry : vector)
    if (std::abs(entry) >= largest * (1.0 - 1e-6)) return entry < 0.0 ? Eigen::VectorXd(-vector) : vector;
  return vector;
}

std::vector<std::size_t> ascending(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

}  // namespace orbweaver::spectrum
