#include "transverse_turns.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "matrix_table.hpp"

namespace orbweaver::spectrum {

namespace {

using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr double turn = 2.0 * std::numbers::pi;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// Of a scaling that balances a matrix of four rows. What is left of the ratio of a row and its column falls by some
/// orders of magnitude in so many sweeps, and all that is asked of it is a factor of 10.
constexpr int balancing_sweeps = 6;
/// Radians over a segment, by which a vector may turn in the frame: 0.4 at most by the chain's own rule for its
/// segments, three times as much with the frame's own turning, and beyond pi they are not told from less.
constexpr double most_between_nodes = 2.0;
/// Cosine of the angle between f and J dH that is taken for -1, where there is no frame.
constexpr double opposite = -0.999;

/// A diagonal scaling in which rows and columns of the Jacobian's mean have equal sums (Osborne 1960): fast and slow
/// coordinates turn at the rates of the flow in it, and not in jumps of almost half a turn.
Vector4d balanced_scales(const Chain& chain) {
  Eigen::Matrix4d mean = Eigen::Matrix4d::Zero();
  for (Eigen::Index m = 0; m < chain.segments(); ++m)
    mean += chain.steps[m] * matrix_in<4>(chain.jacobians, m, 4).cwiseAbs();
  Vector4d scales = Vector4d::Ones();
  for (int sweep = 0; sweep < balancing_sweeps; ++sweep)
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double row = mean.row(i).sum() - mean(i, i);
      const double column = mean.col(i).sum() - mean(i, i);
      if (!(row > 0.0 && column > 0.0)) continue;
      const double factor = std::sqrt(row / column);
      scales[i] *= factor;
      mean.row(i) /= factor;
      mean.col(i) *= factor;
    }
  return scales;
}

/// J x for J = [0 I; -I 0] and the two that make the unit quaternions with it: an orthonormal basis with x.
struct Quaternions {
  Vector4d images[3];

  explicit Quaternions(const Vector4d& x)
      : images{{x[2], x[3], -x[0], -x[1]}, {x[1], -x[0], -x[3], x[2]}, {-x[3], x[2], -x[1], x[0]}} {}
};

/// A frame of the vectors that are orthogonal to f and to the gradient of the energy, in scaled coordinates. With g the
/// unit gradient f is |f| u g, u a unit quaternion without real part: the smallest rotation that takes J to u takes the
/// other two to those of the frame. Along any orbit it is continuous, since u = -J would need M^-1 p = -a p, a > 0.
class Frame {
 public:
  Frame(const Vector4d& gradient, const Vector4d& field, const Vector4d& scales)
      : _scales(scales), _basis(Vector4d(gradient.cwiseProduct(scales)).normalized()) {
    const Vector4d f = Vector4d(field.cwiseQuotient(scales)).normalized();
    for (int k = 0; k < 3; ++k) _u[k] = f.dot(_basis.images[k]);
  }

  [[nodiscard]] bool exists() const { return _u[0] > opposite; }
  /// Of a vector, modulo f.
  [[nodiscard]] Vector2d coordinates(const Vector4d& vector) const {
    const Vector4d v = vector.cwiseQuotient(_scales);
    Eigen::Vector3d w(v.dot(_basis.images[0]), v.dot(_basis.images[1]), v.dot(_basis.images[2]));
    w -= w.dot(_u) * _u;
    const double share = w[0] / (1.0 + _u[0]);
    return {w[1] - _u[1] * share, w[2] - _u[2] * share};
  }

 private:
  Vector4d _scales;
  Quaternions _basis;
  Eigen::Vector3d _u;
};

double angle_between(const Vector2d& from, const Vector2d& to) {
  return std::atan2(from[0] * to[1] - from[1] * to[0], from.dot(to));
}

}  // namespace

double transverse_turns(const Chain& chain, const TransverseFlow& flow, const FundamentalGroup& group, double index,
                        double twist) {
  const Eigen::Index segments = chain.segments();
  const Vector4d scales = balanced_scales(chain);
  const auto basis_at = [&](Eigen::Index m) {
    return Eigen::Map<const Eigen::Matrix<double, 4, 2>>(flow.bases.col(m).data());
  };
  const Frame first(chain.gradients.col(0), chain.fields.col(0), scales);
  if (!first.exists()) return unknown;
  const Vector2d start = Vector2d::UnitX();
  Vector2d carried = start;
  const Vector2d start_there = first.coordinates(basis_at(0) * start);
  Vector2d before = start_there;
  double angle = 0.0;
  // Adds the angle from the last vector to this one; false where it cannot be told.
  const auto pass = [&](const Frame& frame, const Vector4d& vector) {
    if (!frame.exists()) return false;
    const Vector2d here = frame.coordinates(vector);
    const double change = angle_between(before, here);
    if (!(std::abs(change) < most_between_nodes)) return false;
    angle += change;
    before = here;
    return true;
  };
  const Eigen::Index inner = chain.inner_transitions.cols() / segments;
  for (Eigen::Index m = 0; m < segments; ++m) {
    for (Eigen::Index n = m * inner; n < (m + 1) * inner; ++n)
      if (!pass(Frame(chain.inner_gradients.col(n), chain.inner_fields.col(n), scales),
                matrix_in<4>(chain.inner_transitions, n, 4) * (basis_at(m) * carried)))
        return unknown;
    carried = (matrix_in<2>(flow.factors, m, 2) * carried).eval();
    carried.normalize();
    const Frame frame(chain.gradients.col(m + 1), chain.fields.col(m + 1), scales);
    const Vector4d vector =
        m + 1 < segments ? Vector4d(basis_at(m + 1) * carried) : Vector4d(group.generator * (basis_at(0) * carried));
    if (!pass(frame, vector)) return unknown;
    if (m + 1 < segments) continue;
    // The generator turns the frame by a whole or a half turn.
    double gauge = angle_between(start_there, frame.coordinates(group.generator * (basis_at(0) * start)));
    if (gauge < -0.25 * turn) gauge += turn;
    angle -= gauge;
  }
  if (index >= 2.0) return std::round(angle / turn);
  if (index <= -2.0) return std::floor(angle / turn) + 0.5;
  const double phase = std::copysign(std::acos(0.5 * index), twist);
  return phase / turn + std::round((angle - phase) / turn);
}

}  // namespace orbweaver::spectrum
