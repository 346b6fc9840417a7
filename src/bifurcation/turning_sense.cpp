#include "turning_sense.hpp"

#include <cmath>
#include <utility>

#include "orbweaver/bifurcation/test_functions.hpp"

namespace orbweaver::bifurcation {

namespace {

using spectrum::Rotation;
using spectrum::Stability;

/// The product of the cosines of two planes' angles, above which they are one plane that has turned. Of planes that are
/// orthogonal to one another only one can have as much of another plane.
constexpr double same_plane = 0.75;

struct Counterpart {
  const Rotation* rotation = nullptr;
  double overlap = 0.0;  ///< negative where it goes around the other way
};

/// In the plane that the rotation's has become at another orbit.
std::optional<Counterpart> counterpart(const Rotation& of, const Stability& there) {
  Counterpart best;
  for (const Rotation& rotation : there.rotations) {
    const double overlap = Eigen::Matrix2d(of.plane.transpose() * rotation.plane).determinant();
    if (std::abs(overlap) > std::abs(best.overlap)) best = {&rotation, overlap};
  }
  if (!(std::abs(best.overlap) > same_plane)) return std::nullopt;
  return best;
}

}  // namespace

std::optional<TurningSense> TurningSense::reversed_between(const Stability& from, const Stability& to) {
  if (is_elliptic(from) && is_elliptic(to) && from.twist * to.twist < 0.0 &&
      from.fundamental[0].real() + to.fundamental[0].real() > 0.0)
    return TurningSense(from.twist);
  for (const Rotation& rotation : from.rotations) {
    const std::optional<Counterpart> there = counterpart(rotation, to);
    if (there && there->overlap < 0.0 && std::cos(rotation.angle) + std::cos(there->rotation->angle) > 0.0)
      return TurningSense(rotation);
  }
  return std::nullopt;
}

std::optional<double> TurningSense::at(const Stability& orbit) const {
  if (_rotation) {
    const std::optional<Counterpart> there = counterpart(*_rotation, orbit);
    if (!there) return std::nullopt;
    return std::copysign(there->rotation->angle, there->overlap);
  }
  if (std::isnan(orbit.twist) || orbit.fundamental[0].real() - orbit.fundamental_error[0] > 2.0) return std::nullopt;
  return std::copysign(1.0, _twist) * orbit.twist;
}

void TurningSense::carry_to(const Stability& orbit) {
  if (!_rotation) return;
  if (const std::optional<Counterpart> there = counterpart(*_rotation, orbit)) _rotation = *there->rotation;
}

}  // namespace orbweaver::bifurcation
