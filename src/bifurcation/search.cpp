#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <boost/math/distributions/normal.hpp>

namespace orbweaver::bifurcation {

namespace {

constexpr double same_direction = 0.02;  // radians; after the second correction they agree much closer
constexpr double settled = 1e-3;         // radians between the pinned direction and the one of the orbit found
constexpr double largest_tilt = 1.0;
constexpr int most_pins = 8;

// The radical inverse of n in a base: a number in (0, 1).
double halton(int n, int base) {
  double value = 0.0;
  double weight = 1.0 / base;
  for (; n > 0; n /= base, weight /= base) value += weight * (n % base);
  return value;
}

// Where the orbit leaves the base, or nothing if it is not near the base along the kernel.
std::optional<Eigen::VectorXd> direction_of(const loop::Loop& base, const SymmetryGroup& group, const loop::Loop& orbit,
                                            double amplitude) {
  const std::vector<double> start = loop::with_cutoff(base, orbit.cutoff).modes;
  Eigen::VectorXd gap = Eigen::Map<const Eigen::VectorXd>(orbit.modes.data(), static_cast<Eigen::Index>(start.size())) -
                        Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  const Eigen::VectorXd inside = group.coordinates_of({gap.data(), static_cast<std::size_t>(gap.size())});
  const double length = inside.norm();
  const double outside = std::sqrt(std::max(0.0, gap.squaredNorm() - length * length));
  if (!(length <= amplitude / std::cos(largest_tilt) && outside <= length)) return std::nullopt;
  return inside / length;
}

}  // namespace

std::vector<FoundOrbit> search_directions(const systems::System& system, const loop::Loop& base,
                                          const SymmetryGroup& group, const loop::Isotropy& isotropy,
                                          const std::vector<Eigen::VectorXd>& starts, double amplitude,
                                          const std::vector<Eigen::VectorXd>& known,
                                          const corrector::Options& options) {
  std::vector<FoundOrbit> found;
  std::vector<Eigen::VectorXd> taken = known;
  const auto is_new = [&](const Eigen::VectorXd& coordinates) {
    return std::none_of(taken.begin(), taken.end(), [&](const Eigen::VectorXd& other) {
      return group.image(coordinates, other, same_direction) != 0;
    });
  };
  for (const Eigen::VectorXd& start : starts) {
    // Newton's method turns away from the direction that it is pinned to, or stalls on the way: it is pinned again to the
    // one it came to, until that stays. Then the part in the kernel has the amplitude itself.
    Eigen::VectorXd pinned = start;
    for (int pins = 0; pins < most_pins; ++pins) {
      const corrector::Result result = born_orbit(system, base, group.modes_of(pinned), isotropy, amplitude, options);
      const auto direction = direction_of(base, group, result.loop, amplitude);
      if (!direction) break;
      const double tilt = (*direction - pinned).norm();
      pinned = *direction;
      if (!result.converged()) continue;
      if (!is_new(pinned)) break;
      if (tilt > settled) continue;
      taken.push_back(pinned);
      found.push_back({pinned, result.loop});
      break;
    }
  }
  return found;
}

std::vector<Eigen::VectorXd> start_directions(int dimension, int order, int count) {
  std::vector<Eigen::VectorXd> out;
  if (dimension == 2) {
    for (int n = 0; n < count; ++n) {
      const double angle = 2.0 * std::numbers::pi / order * n / count;
      out.emplace_back(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return out;
  }
  constexpr int primes[] = {2, 3, 5, 7, 11, 13, 17, 19};
  for (int n = 1; n <= count << (dimension - 1); ++n) {
    Eigen::VectorXd v(dimension);
    for (int i = 0; i < dimension; ++i)
      v(i) = boost::math::quantile(boost::math::normal(), halton(n, primes[static_cast<std::size_t>(i)]));
    if (v.norm() > 0.1) out.push_back(v.normalized());
  }
  return out;
}

}  // namespace orbweaver::bifurcation
