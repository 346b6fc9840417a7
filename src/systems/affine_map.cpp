#include "orbweaver/systems/affine_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/numerics/decompositions.hpp"
#include "structure_error.hpp"

namespace orbweaver::systems {

namespace {

/// Products of declared matrices and angles are wrong by rounding only; different ones differ by much more.
constexpr double same = 1e-9;

}  // namespace

AffineMap::AffineMap(Eigen::MatrixXd linear, Eigen::VectorXd constant)
    : matrix(std::move(linear)), offset(std::move(constant)) {
  if (matrix.rows() != matrix.cols() || matrix.rows() != offset.size())
    throw StructureError(
        fmt::format("an affine map is of a {} x {} matrix and an offset of {} entries: give it a square "
                    "matrix, and an offset of its size",
                    matrix.rows(), matrix.cols(), offset.size()));
}

AffineMap AffineMap::identity(int dimension) { return Eigen::MatrixXd::Identity(dimension, dimension); }

AffineMap AffineMap::inverse() const {
  const Eigen::MatrixXd back = matrix.inverse();
  return {back, -(back * offset)};
}

bool AffineMap::is_same(const AffineMap& other, const std::vector<int>& angles) const {
  if (!matrix.isApprox(other.matrix, same)) return false;
  return std::all_of(angles.begin(), angles.end(), [&](int i) {
    return std::abs(std::remainder(offset(i) - other.offset(i), 2.0 * std::numbers::pi)) < same;
  });
}

AffineMap operator*(const AffineMap& after, const AffineMap& before) {
  return {after.matrix * before.matrix, after.matrix * before.offset + after.offset};
}

}  // namespace orbweaver::systems
