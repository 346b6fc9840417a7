#include "turning_sense.hpp"

#include <cmath>
#include <utility>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "same_plane.hpp"

namespace orbweaver::bifurcation {

using spectrum::Rotation;
using spectrum::Stability;

std::optional<TurningSense> TurningSense::reversed_between(const Stability& from, const Stability& to) {
  if (is_elliptic(from) && is_elliptic(to) && from.twist * to.twist < 0.0 &&
      from.fundamental[0].real() + to.fundamental[0].real() > 0.0)
    return TurningSense(from.twist);
  for (const Rotation& rotation : from.rotations) {
    const Counterpart there = counterpart(rotation, to);
    if (there && there.overlap < 0.0 && std::cos(rotation.angle) + std::cos(there.rotation->angle) > 0.0)
      return TurningSense(rotation);
  }
  return std::nullopt;
}

std::optional<double> TurningSense::at(const Stability& orbit) const {
  if (_rotation) {
    const Counterpart there = counterpart(*_rotation, orbit);
    if (!there) return std::nullopt;
    return std::copysign(there.rotation->angle, there.overlap);
  }
  if (std::isnan(orbit.twist) || orbit.fundamental[0].real() - orbit.fundamental_error[0] > 2.0) return std::nullopt;
  return std::copysign(1.0, _twist) * orbit.twist;
}

void TurningSense::carry_to(const Stability& orbit) {
  if (!_rotation) return;
  if (const Counterpart there = counterpart(*_rotation, orbit)) _rotation = *there.rotation;
}

}  // namespace orbweaver::bifurcation
