#include "leaving.hpp"

#include <algorithm>
#include <cmath>

namespace orbweaver::bifurcation {

namespace {

/// Radians between an oscillation and its images, as far apart as those that a search tells apart; and what is seen of
/// a harmonic in a direction of unit length, known to the amplitude of a search.
constexpr double same_image = 0.02;
constexpr double visible_harmonic = 1e-3;
/// The amplitude at which base and direction are looked at together, and what a symmetry may be off there, in the
/// base's tolerances. What the direction breaks is off by the order of the amplitude: neither decides.
constexpr double probe_amplitude = 0.1;
constexpr double probe_tolerance = 10.0;

}  // namespace

loop::Isotropy isotropy_along(const systems::Structure& system, const KernelActions& group, const loop::Loop& base,
                              const loop::Tangent& along, const DirectionOptions& options) {
  return loop::find_isotropy(system, loop::moved(base, along, probe_amplitude),
                             probe_tolerance * options.symmetry_tolerance, group.denominator());
}

bool has_other_sides(const KernelActions& group, const Eigen::VectorXd& v) {
  if (group.constant()) return group.image(v, -v, same_line) == 0;
  return std::none_of(group.actions().begin(), group.actions().end(), [&](const Action& a) { return a.maps(v, -v); });
}

Direction counted(const KernelActions& group, const Eigen::VectorXd& v, Direction direction) {
  if (!group.constant()) return direction;
  direction.images = group.images(v, same_image);
  direction.repetitions = group.times_around(v, visible_harmonic);
  return direction;
}

loop::Tangent leaving_along(loop::Tangent in_kernel, double along, const loop::Tangent& family) {
  if (family.modes.empty() || along == 0.0) return in_kernel;
  double square = 0.0;
  for (const double v : family.modes) square += v * v;
  const double share = along / std::sqrt(square);
  for (std::size_t n = 0; n < in_kernel.modes.size(); ++n) in_kernel.modes[n] += share * family.modes[n];
  in_kernel.normalize();
  return in_kernel;
}

}  // namespace orbweaver::bifurcation
