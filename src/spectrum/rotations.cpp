#include "rotations.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "matrix_table.hpp"
#include "orbweaver/numerics/eigenvalues.hpp"

namespace orbweaver::spectrum {

namespace {

using Complex = std::complex<double>;
using Plane = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Roundings that a product's entries have, in parts of its norm. Where they move an index by more than the next
/// number, no vector is that pair's.
constexpr double product_roundings = 1e3;
/// By which the index of the vector that is taken may differ from the known one.
constexpr double same_index = 1e-4;
/// Two indices that are no further apart have one space of four dimensions, and no planes of their own: those of a
/// double one, which symmetry forces, are rounding's.
constexpr double double_index = 1e-9;

bool is_double(const Stability& known, std::size_t n) {
  for (std::size_t m = 0; m < known.fundamental.size(); ++m)
    if (m != n && std::abs(known.fundamental[m] - known.fundamental[n]) <= double_index) return true;
  return false;
}

/// P v = mu v, v = a + i b: P a = a cos - b sin, so that a goes towards -b where mu's imaginary part is positive.
Plane plane_of(const Eigen::VectorXcd& vector) {
  Plane plane(vector.size(), 2);
  plane.col(0) = vector.real().normalized();
  plane.col(1) = -vector.imag();
  plane.col(1) -= plane.col(0).dot(plane.col(1)) * plane.col(0);
  plane.col(1).normalize();
  return plane;
}

}  // namespace

Eigen::MatrixXd transverse_map(const TransverseFlow& flow) {
  const Eigen::Index size = flow.dimension();
  Eigen::MatrixXd product = matrix_in<Eigen::Dynamic>(flow.factors, 0, size);
  for (Eigen::Index m = 1; m < flow.factors.cols(); ++m)
    product = (matrix_in<Eigen::Dynamic>(flow.factors, m, size) * product).eval();
  const double rounding = product_roundings * std::numeric_limits<double>::epsilon() * product.norm();
  if (!(rounding < same_index)) return {};
  return product;
}

std::vector<Rotation> rotations(const systems::System& system, const Chain& chain, const Stability& known) {
  if (known.map.size() == 0) return {};
  const std::optional<numerics::Eigensystem> eigen = numerics::eigensystem(known.map, true);
  if (!eigen) return {};
  const Eigen::MatrixXd basis = transverse_basis(system, chain, 0);
  std::vector<Rotation> result;
  for (std::size_t n = 0; n < known.fundamental.size(); ++n) {
    const Complex index = known.fundamental[n];
    if (index.imag() != 0.0 || !(std::abs(index.real()) + known.fundamental_error[n] < 2.0)) continue;
    if (is_double(known, n)) continue;
    const double angle = std::acos(0.5 * index.real());
    const Complex multiplier = std::polar(1.0, angle);
    Eigen::Index nearest = 0;
    (eigen->values.array() - multiplier).abs().minCoeff(&nearest);
    const Complex value = eigen->values[nearest];
    if (!(value.imag() > 0.0) || !(std::abs(value + std::conj(value) - index) < same_index)) continue;
    Rotation rotation{angle, basis * plane_of(eigen->vectors.col(nearest))};
    if (rotation.plane.allFinite()) result.push_back(std::move(rotation));
  }
  return result;
}

}  // namespace orbweaver::spectrum
