#include "turning_sense.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "same_plane.hpp"

namespace orbweaver::bifurcation {

using spectrum::Rotation;
using spectrum::Stability;

namespace {

/// Radians, below which a pair may come to 1 within a step.
constexpr double near_one = 0.5;

bool all_are_told(const Stability& here, const Stability& there) {
  return std::all_of(here.rotations.begin(), here.rotations.end(), [&](const Rotation& rotation) {
    return rotation.angle > near_one || counterpart(rotation, there);
  });
}

}  // namespace

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

bool TurningSense::is_untold(const Stability& from, const Stability& to) {
  return from.rotations.size() == to.rotations.size() && !(all_are_told(from, to) && all_are_told(to, from));
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
