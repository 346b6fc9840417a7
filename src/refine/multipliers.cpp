#include "multipliers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>

#include "orbweaver/core/error.hpp"

namespace orbweaver::refine {

namespace {

using numerics::Extended;

/// Of the decimal logarithm: moduli that are nearer are equal, as on the unit circle.
constexpr double same_modulus = 1e-6;

Extended square_of(const ExtendedMultiplier& x) { return x.real * x.real + x.imaginary * x.imaginary; }

/// From the blocks of a real Schur form.
std::vector<ExtendedMultiplier> eigenvalues(const numerics::ExtendedMatrix& matrix) {
  const Eigen::RealSchur<numerics::ExtendedMatrix> schur(matrix, false);
  if (schur.info() != Eigen::Success) throw core::NumericalError("the multipliers could not be separated");
  const numerics::ExtendedMatrix& t = schur.matrixT();
  std::vector<ExtendedMultiplier> found;
  for (Eigen::Index i = 0; i < t.rows(); ++i) {
    if (i + 1 == t.rows() || t(i + 1, i) == 0) {
      found.push_back({t(i, i), Extended(0)});
      continue;
    }
    const Extended half = (t(i, i) - t(i + 1, i + 1)) / 2;
    const Extended middle = (t(i, i) + t(i + 1, i + 1)) / 2;
    const Extended discriminant = half * half + t(i, i + 1) * t(i + 1, i);
    const Extended root = sqrt(Extended(abs(discriminant)));
    if (discriminant < 0) {
      found.push_back({middle, root});
    } else {
      found.push_back({Extended(middle + root), Extended(0)});
      found.push_back({Extended(middle - root), Extended(0)});
    }
    ++i;
  }
  return found;
}

}  // namespace

std::vector<ExtendedMultiplier> nontrivial_multipliers(const numerics::ExtendedMatrix& monodromy,
                                                       const Extended& determinant) {
  std::vector<ExtendedMultiplier> found = eigenvalues(monodromy);
  const auto from_one = [](const ExtendedMultiplier& x) { return square_of({Extended(x.real - 1), x.imaginary}); };
  found.erase(std::min_element(found.begin(), found.end(),
                               [&](const auto& a, const auto& b) { return from_one(a) < from_one(b); }));
  const auto modulus = [](const ExtendedMultiplier& x) {
    return std::round(0.5 * numerics::log10_abs(square_of(x)) / same_modulus);
  };
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    const double of_a = modulus(a);
    const double of_b = modulus(b);
    return of_a != of_b ? of_a > of_b : a.real > b.real;
  });
  if (!found.empty() && found.back().imaginary == 0) {
    Extended others(1);
    for (std::size_t n = 0; n + 1 < found.size(); ++n)
      others *= found[n].imaginary == 0 ? found[n].real : square_of(found[n]);
    found.back().real = determinant / others;
  }
  return found;
}

}  // namespace orbweaver::refine
