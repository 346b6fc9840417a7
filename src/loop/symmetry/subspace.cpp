#include "orbweaver/loop/symmetry/subspace.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::loop {

namespace {

constexpr double zero_weight = 1e-14;
/// Singular values of conditions made of sines and cosines, relative to the largest: they vanish to some roundings or
/// are those of a rotation.
constexpr double vanishing = 1e-10;
/// Columns as long as the longest but for this are equally good pivots: the first one is taken, whatever rounding says.
constexpr double equally_long = 1e-12;

// g acting on (a_k, b_k), a vector of 2 x dimension (of dimension alone for k = 0).
Eigen::MatrixXd harmonic_action(const SymmetryElement& g, int k) {
  const Eigen::Index d = g.map.matrix.rows();
  const Eigen::MatrixXd inverse = g.map.matrix.inverse();
  if (k == 0) return inverse;
  // The phase is reduced before the trigonometric functions, so that k and k + q give the same bits.
  const int turns = (k * (g.shift_numerator % g.shift_denominator)) % g.shift_denominator;
  const double angle = 2.0 * std::numbers::pi * turns / g.shift_denominator;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::MatrixXd action(2 * d, 2 * d);
  const double sign = g.reversing ? -1.0 : 1.0;
  action.topLeftCorner(d, d) = c * inverse;
  action.topRightCorner(d, d) = s * inverse;
  action.bottomLeftCorner(d, d) = -sign * s * inverse;
  action.bottomRightCorner(d, d) = sign * c * inverse;
  return action;
}

// Orthonormal basis of the common fixed space: projector from the singular vectors of the stacked conditions, then its
// columns by pivoted Gram-Schmidt, which gives single coefficients where the symmetries only change signs.
Eigen::MatrixXd fixed_space(const std::vector<Eigen::MatrixXd>& conditions, Eigen::Index size) {
  if (conditions.empty()) return Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd stacked(size * static_cast<Eigen::Index>(conditions.size()), size);
  for (std::size_t c = 0; c < conditions.size(); ++c)
    stacked.middleRows(static_cast<Eigen::Index>(c) * size, size) = conditions[c];
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(stacked, Eigen::ComputeFullV);
  const double cut = vanishing * std::max(1.0, svd.singularValues().size() > 0 ? svd.singularValues()(0) : 1.0);
  const Eigen::Index rank = (svd.singularValues().array() > cut).count();
  const Eigen::MatrixXd kernel = svd.matrixV().rightCols(size - rank);
  Eigen::MatrixXd rest = kernel * kernel.transpose();
  Eigen::MatrixXd basis(size, size - rank);
  for (Eigen::Index n = 0; n < basis.cols(); ++n) {
    Eigen::Index pivot = 0;
    for (Eigen::Index c = 1; c < size; ++c)
      if (rest.col(c).norm() > rest.col(pivot).norm() + equally_long) pivot = c;
    basis.col(n) = rest.col(pivot).normalized();
    if (basis(pivot, n) < 0.0) basis.col(n) = -basis.col(n);
    rest -= basis.col(n) * (basis.col(n).transpose() * rest).eval();
  }
  return basis;
}

int period_of_pattern(const Isotropy& isotropy) {
  int period = 1;
  for (const SymmetryElement& g : isotropy) period = std::lcm(period, g.shift_denominator);
  return period;
}

}  // namespace

Subspace Subspace::unrestricted(int dimension, int cutoff) { return {dimension, cutoff, Isotropy{}}; }

Subspace::Subspace(int dimension, int cutoff, const Isotropy& isotropy, std::span<const int> signs)
    : _dimension(dimension), _cutoff(cutoff), _isotropy(isotropy), _signs(signs.begin(), signs.end()) {
  if (_signs.empty()) _signs.assign(isotropy.size(), 1);
  core::require(dimension >= 1 && cutoff >= 1, "a subspace needs at least one coordinate and one harmonic");
  core::require(signs.empty() || signs.size() == isotropy.size(), "a sign a generator of the isotropy is needed");
  for (const SymmetryElement& g : isotropy)
    core::require(g.map.matrix.rows() == dimension && g.map.matrix.cols() == dimension,
                  "a symmetry of another dimension");
  const int pattern = period_of_pattern(isotropy);
  std::map<int, Eigen::MatrixXd> known;
  for (int k = 0; k <= cutoff; ++k) {
    const int key = k == 0 ? -1 : k % pattern;
    auto found = known.find(key);
    if (found == known.end()) {
      const Eigen::Index size = k == 0 ? dimension : 2 * dimension;
      std::vector<Eigen::MatrixXd> conditions;
      for (std::size_t n = 0; n < isotropy.size(); ++n) {
        const double sign = signs.empty() ? 1.0 : signs[n];
        conditions.push_back(harmonic_action(isotropy[n], k) - sign * Eigen::MatrixXd::Identity(size, size));
      }
      found = known.emplace(key, fixed_space(conditions, size)).first;
    }
    append_harmonic(k, found->second);
  }
}

Subspace Subspace::image() const {
  std::vector<int> signs = _signs;
  for (std::size_t n = 0; n < signs.size(); ++n)
    if (_isotropy[n].reversing) signs[n] = -signs[n];
  return {_dimension, _cutoff, _isotropy, signs};
}

void Subspace::append_harmonic(int k, const Eigen::MatrixXd& basis) {
  for (Eigen::Index n = 0; n < basis.cols(); ++n) {
    for (Eigen::Index e = 0; e < basis.rows(); ++e) {
      if (std::abs(basis(e, n)) < zero_weight) continue;
      const int part = static_cast<int>(e) / _dimension;
      const int row = k == 0 ? 0 : 2 * k - 1 + part;
      _entries.push_back({row, static_cast<int>(e) % _dimension, basis(e, n)});
    }
    _begin.push_back(_entries.size());
  }
}

void Subspace::add_to(std::span<const double> coordinates, std::span<double> modes) const {
  core::require(static_cast<int>(coordinates.size()) == size(), "a coordinate a basis vector is needed");
  core::require(modes.size() == (2 * static_cast<std::size_t>(_cutoff) + 1) * static_cast<std::size_t>(_dimension),
                "the modes and the subspace have different sizes");
  for (int n = 0; n < size(); ++n)
    for (const Entry& e : basis(n))
      modes[static_cast<std::size_t>(e.row * _dimension + e.coordinate)] +=
          e.weight * coordinates[static_cast<std::size_t>(n)];
}

void Subspace::project(std::span<const double> modes, std::span<double> coordinates) const {
  core::require(static_cast<int>(coordinates.size()) == size(), "a coordinate a basis vector is needed");
  core::require(modes.size() == (2 * static_cast<std::size_t>(_cutoff) + 1) * static_cast<std::size_t>(_dimension),
                "the modes and the subspace have different sizes");
  for (int n = 0; n < size(); ++n) {
    double sum = 0.0;
    for (const Entry& e : basis(n))
      sum += e.weight * modes[static_cast<std::size_t>(e.row * _dimension + e.coordinate)];
    coordinates[static_cast<std::size_t>(n)] = sum;
  }
}

}  // namespace orbweaver::loop
