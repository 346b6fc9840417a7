#include "orbweaver/bifurcation/parted_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orbweaver/bifurcation/stability_of_orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// Two crossings that their index does not tell apart lie within so much of the interval in which it comes and goes, or
/// within the second number. The minimum between them is found to 1e-8 of that.
constexpr double share_beside = 1e-3;
constexpr double least_beside = 1e-5;
constexpr double least_width = 1e-9;
/// From there brackets begin so wide, in parts of 1 + |position|, and widen so much at a time.
constexpr double first_width = 1e-10;
constexpr double widening = 4.0;

}  // namespace

Reading determinant_deviation(const systems::Structure& system, const spectrum::Stability& stability,
                              const Sector& sector) {
  const Eigen::Index size = stability.map.rows();
  if (!system.symplectic || sector.q > 2 || size == 0) return {unknown, unknown};
  const double value = sector.value(true);
  const double multiplier = 0.5 * value;
  const Eigen::MatrixXd difference = stability.map - multiplier * Eigen::MatrixXd::Identity(size, size);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(difference);
  std::size_t nearest = 0;
  for (std::size_t n = 1; n < stability.fundamental.size(); ++n)
    if (std::abs(stability.fundamental[n] - value) < std::abs(stability.fundamental[nearest] - value)) nearest = n;
  std::complex<double> others = 1.0;
  for (std::size_t n = 0; n < stability.fundamental.size(); ++n)
    if (n != nearest) others *= -multiplier * (stability.fundamental[n] - value);
  const double deviation = -multiplier * lu.determinant() / others.real();
  // What the map's entries are wrong by, as the trace of a pair's map, changes it by so much.
  const double share = stability.fundamental_error[nearest] * lu.inverse().norm();
  return {deviation, share < 1.0 ? std::abs(deviation) * share : std::numeric_limits<double>::infinity()};
}

std::optional<std::array<Parted, 2>> parted_crossings(const systems::System& system, continuation::FamilyCurve& family,
                                                      const Sector& sector, double place, double from, double to) {
  const double half = std::max(share_beside * (to - from), least_beside);
  from = std::max(from, place - half);
  to = std::min(to, place + half);
  const auto reading = [&](double position) -> Reading {
    const auto point = family.at(position);
    if (!point) return {unknown, unknown};
    try {
      return determinant_deviation(
          system.structure(), stability_of(system, point->loop, family.isotropy(), family.options().corrector.team),
          sector);
    } catch (const core::NumericalError&) {
      return {unknown, unknown};
    }
  };
  const int side = reading(from).sign();
  if (side == 0 || reading(to).sign() != side) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  double between = unknown;
  const auto towards = [&](double position) {
    const double value = side * reading(position).value;
    if (value < least) {
      least = value;
      between = position;
    }
    return value;
  };
  (void)numerics::locate_minimum(towards, from, to, least_width * (to - from));
  // At a kernel of two dimensions that a symmetry forces rounding made the determinant 6 times its error bound there.
  if (std::isnan(between) || reading(between).clear_sign() != -side) return std::nullopt;
  const auto bracket = [&](double direction, double end) {
    for (double width = first_width * (1.0 + std::abs(between));; width *= widening) {
      const double position = between + direction * width;
      if (direction * (end - position) <= 0.0) return end;
      if (reading(position).sign() == side) return position;
    }
  };
  return std::array{Parted{bracket(-1.0, from), between}, Parted{between, bracket(1.0, to)}};
}

}  // namespace orbweaver::bifurcation
