#include "start_vector.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::spectrum {

namespace {

/// Fractional parts of its multiples fill [0, 1) evenly (the golden ratio less 1).
constexpr double golden = 0.6180339887498949;
/// Entries that agree to this count as equally large, so that rounding does not choose the one that fixes the sign.
constexpr double equally_large = 1e-6;

}  // namespace

core::Handle<Vec> start_vector(int size, int number) {
  core::Handle<Vec> vector = loss::create_vector(size);
  Eigen::VectorXd values(size);
  // Quasi-random and without symmetry, so that no eigenvector is orthogonal to it by accident.
  for (int n = 0; n < size; ++n) values(n) = 0.5 + std::fmod(golden * (number + 1.0) * (n + 1), 1.0);
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
    if (std::abs(entry) >= largest * (1.0 - equally_large)) return entry < 0.0 ? Eigen::VectorXd(-vector) : vector;
  return vector;
}

std::vector<std::size_t> ascending(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

}  // namespace orbweaver::spectrum
