#include "linear_modes.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::starts {

namespace {

using Complex = std::complex<double>;

Eigen::JacobiSVD<Eigen::MatrixXcd> singular_vectors(const Eigen::MatrixXcd& m) {
  return Eigen::JacobiSVD<Eigen::MatrixXcd>(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

// g of [M B; C' 0] [X; g] = [0; 1]: singular exactly where M is, and smooth in T.
class Border {
 public:
  Border(const Eigen::MatrixXcd& near_singular, Eigen::Index borders) : _size(near_singular.rows()), _borders(borders) {
    const auto svd = singular_vectors(near_singular);
    _left = svd.matrixU().rightCols(borders);
    _right = svd.matrixV().rightCols(borders);
  }

  [[nodiscard]] Eigen::MatrixXcd value(const Eigen::MatrixXcd& m) const {
    Eigen::MatrixXcd whole = Eigen::MatrixXcd::Zero(_size + _borders, _size + _borders);
    whole.topLeftCorner(_size, _size) = m;
    whole.topRightCorner(_size, _borders) = _left;
    whole.bottomLeftCorner(_borders, _size) = _right.adjoint();
    Eigen::MatrixXcd right_side = Eigen::MatrixXcd::Zero(_size + _borders, _borders);
    right_side.bottomRows(_borders).setIdentity();
    return whole.partialPivLu().solve(right_side).bottomRows(_borders);
  }

 private:
  Eigen::Index _size;
  Eigen::Index _borders;
  Eigen::MatrixXcd _left;
  Eigen::MatrixXcd _right;
};

}  // namespace

LinearModes::LinearModes(const systems::System& system, std::span<const double> fixed_point) {
  const auto d = static_cast<Eigen::Index>(system.dimension());
  core::require(static_cast<Eigen::Index>(fixed_point.size()) == d, "a fixed point of another dimension");
  std::vector<double> f(fixed_point.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> a(d, d);
  system.field_jacobian(1, fixed_point.data(), f.data(), a.data());
  _a = a;
}

Eigen::MatrixXcd LinearModes::matrix(int k, double period) const {
  const Complex rate(0.0, 2.0 * std::numbers::pi * k / period);
  return rate * Eigen::MatrixXcd::Identity(_a.rows(), _a.cols()) - _a.cast<Complex>();
}

Eigen::VectorXcd LinearModes::smallest_right_singular_vector(int k, double period) const {
  return singular_vectors(matrix(k, period)).matrixV().rightCols(1);
}

std::vector<LinearModes::Root> LinearModes::roots(int k, double low, double near, double high, int depth) const {
  constexpr int deepest = 4;  // divisions of a bracket: parts^4 tells periods apart that differ by 1e-6 of it
  constexpr int parts = 40;
  // Singular values of M move no faster than |dM/dT| = 2 pi k / T^2: only those within reach of 0 in the bracket can
  // vanish.
  const double reach = 2.0 * std::numbers::pi * k / (low * low) * (high - low);
  const auto smallest_at = [&](double period) { return singular_vectors(matrix(k, period)).singularValues(); };
  const Eigen::VectorXd sigma = smallest_at(near);
  const Eigen::Index vanishing = (sigma.array() <= reach).count();
  if (vanishing < 1) return {};
  if (const auto together = bordered_root(k, low, near, high, vanishing)) return {*together};
  std::vector<Root> found;
  if (vanishing > 1 && depth < deepest) {
    std::vector<double> dips;
    for (int n = 0; n <= parts; ++n) dips.push_back(smallest_at(low + (high - low) * n / parts).minCoeff());
    for (int n = 1; n < parts; ++n) {
      const auto i = static_cast<std::size_t>(n);
      if (!(dips[i] < dips[i - 1] && dips[i] <= dips[i + 1])) continue;
      const auto at = [&](int m) { return low + (high - low) * m / parts; };
      for (const Root& root : roots(k, at(n - 1), at(n), at(n + 1), depth + 1)) found.push_back(root);
    }
  }
  for (Eigen::Index borders = vanishing - 1; borders >= 1 && found.empty(); --borders)
    if (const auto fewer = bordered_root(k, low, near, high, borders)) found.push_back(*fewer);
  return found;
}

std::optional<LinearModes::Root> LinearModes::bordered_root(int k, double low, double near, double high,
                                                            Eigen::Index borders) const {
  const Border border(matrix(k, near), borders);
  constexpr double difference = 1e-4;  // of the bracket: the slope sets the sign and scale of the function only
  constexpr double vanished = 1e-10;   // of |A|: rounding of M at a root, with room for defective eigenvalues
  constexpr double position_width = 4.0 * std::numeric_limits<double>::epsilon();  // of T: rounding
  const double h = difference * (high - low);
  const Eigen::MatrixXcd slope = (border.value(matrix(k, near + h)) - border.value(matrix(k, near - h))) / (2.0 * h);
  const Eigen::MatrixXcd inverse_slope = slope.inverse();
  const auto signed_distance = [&](double period) {
    return (border.value(matrix(k, period)) * inverse_slope).trace().real() / static_cast<double>(borders);
  };
  const double at_low = signed_distance(low);
  const double at_high = signed_distance(high);
  if (!(at_low * at_high < 0.0)) return std::nullopt;
  const auto root = numerics::locate_root(signed_distance, {low, at_low}, {high, at_high}, position_width * near);
  if (!root) return std::nullopt;
  const double period = root->position;
  const auto svd = singular_vectors(matrix(k, period));
  const Eigen::Index first = svd.singularValues().size() - borders;
  Root out{period, static_cast<int>(borders), svd.singularValues()(first), svd.matrixV().rightCols(borders)};
  if (out.residual > vanished * scale()) return std::nullopt;
  return out;
}

}  // namespace orbweaver::starts
