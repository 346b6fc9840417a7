#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <boost/math/distributions/normal.hpp>

#include "born_orbit.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "standard_image.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double same_direction = 0.02;  // radians; settled ones agree much closer
constexpr double settled = 1e-3;         // radians between the pinned direction and the one of the orbit found
constexpr double largest_tilt = 1.0;     // radians; an orbit that leaves the base further off lies elsewhere
constexpr double farthest_along = 10.0;  // of the part in the kernel: further along the family it is another place
constexpr int most_pins = 8;             // each a Newton solve; not measured
constexpr double returned = 0.2;         // of the nudge: what remains of it at an isolated direction, which is settled
/// A family that comes so near to another direction (in radians) is born there, at an amplitude smaller by its square.
constexpr double touching = 0.05;
constexpr int most_halvings = 10;     // of the distance: from 1 to 0.001 radians
constexpr double least_length = 0.1;  // of a normal vector: shorter ones are rounded to few directions

// The radical inverse of n in a base: a number in (0, 1).
double halton(int n, int base) {
  double value = 0.0;
  double weight = 1.0 / base;
  for (; n > 0; n /= base, weight /= base) value += weight * (n % base);
  return value;
}

struct Search {
  const systems::System& system;
  const loop::Loop& base;
  const KernelActions& group;
  const loop::Isotropy& isotropy;
  double amplitude;
  const DirectionOptions& options;

  // Nothing if it is not near the base along the kernel and the base's family.
  [[nodiscard]] std::optional<Gap> near_gap(const loop::Loop& orbit) const {
    Gap gap = gap_between(base, orbit, group, options.family.modes);
    const double length = gap.inside.norm();
    if (!(length <= amplitude / std::cos(largest_tilt) && gap.beside <= length &&
          std::abs(gap.along) <= farthest_along * length))
      return std::nullopt;
    return gap;
  }

  // Newton's method turns away from the direction that it is pinned to, or stalls on the way: it is pinned again to the
  // one it came to, with the period it came to, until that stays. Then the part in the kernel has the amplitude itself.
  template <class Unwanted>
  [[nodiscard]] std::optional<FoundOrbit> settle(Eigen::VectorXd pinned, double period, const Unwanted& unwanted,
                                                 bool* is_unwanted = nullptr) const {
    loop::Loop from = base;
    from.period = period;
    for (int pins = 0; pins < most_pins; ++pins) {
      const corrector::Result result =
          born_orbit(system, from, group.vector_at(pinned), isotropy, amplitude, options.corrector);
      const std::optional<Gap> gap = near_gap(result.loop);
      if (!gap) return std::nullopt;
      const double length = gap->inside.norm();
      const double tilt = (gap->inside / length - pinned).norm();
      pinned = gap->inside / length;
      from.period = result.loop.period;
      if (result.converged() && unwanted(pinned)) {
        if (is_unwanted != nullptr) *is_unwanted = true;
        return std::nullopt;
      }
      if (tilt > settled) continue;
      if (!result.converged()) return std::nullopt;
      return FoundOrbit{pinned, gap->along / length, result.loop};
    }
    return std::nullopt;
  }

  // Neighbouring directions lead back to it, or on to one that is `taken`: it is neither one of a continuum nor one
  // where the loss, at this amplitude, is below its threshold along all directions. They are sought from its period:
  // with another one Newton's method may leave it wherever it begins (a ring of Toda particles).
  template <class Taken>
  [[nodiscard]] bool is_isolated(const FoundOrbit& orbit, double nudge, const Taken& taken) const {
    const Eigen::VectorXd& v = orbit.coordinates;
    Eigen::MatrixXd along = v;
    if (group.constant()) {
      along.conservativeResize(Eigen::NoChange, 2);
      along.col(1) = group.turn() * v;
    }
    const Eigen::Index others = v.size() - along.cols();
    const Eigen::MatrixXd axes = along.householderQr().householderQ();
    for (const Eigen::VectorXd& aside : axes.rightCols(others).colwise()) {
      const auto none = [](const Eigen::VectorXd&) { return false; };
      const auto back = settle((v + nudge * aside).normalized(), orbit.loop.period, none);
      if (!back) return false;
      if ((back->coordinates - v).norm() > returned * nudge && !taken(back->coordinates)) return false;
    }
    return true;
  }

  // Among the orbits with its symmetries: the loss may hardly see the phase that these fix.
  template <class Taken>
  [[nodiscard]] std::optional<FoundOrbit> isolated_by_symmetry(const FoundOrbit& orbit, double nudge,
                                                               const Taken& taken) const {
    const double tolerance = found_tolerance * amplitude;
    const loop::Loop standard = standard_image(system.structure(), group, orbit.loop, tolerance);
    const loop::Isotropy own = loop::find_isotropy(system.structure(), standard, tolerance, group.denominator());
    if (own.size() <= isotropy.size()) return std::nullopt;
    const Search among{system, base, group, own, amplitude, options};
    const auto none = [](const Eigen::VectorXd&) { return false; };
    std::optional<FoundOrbit> found =
        among.settle(gap_between(base, standard, group, {}).inside.normalized(), base.period, none);
    if (!found || !among.is_isolated(*found, nudge, taken)) return std::nullopt;
    return found;
  }
};

}  // namespace

Gap gap_between(const loop::Loop& base, const loop::Loop& orbit, const KernelActions& group,
                const std::vector<double>& family) {
  std::vector<double> gap = loop::with_cutoff(base, orbit.cutoff).modes;
  for (std::size_t n = 0; n < gap.size(); ++n) gap[n] = orbit.modes[n] - gap[n];
  Gap out;
  out.inside = group.coordinates_of(gap);
  Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(gap.data(), static_cast<Eigen::Index>(gap.size()));
  if (!family.empty()) {
    const Eigen::Map<const Eigen::VectorXd> direction(family.data(), static_cast<Eigen::Index>(family.size()));
    const Eigen::VectorXd unit = direction.normalized();
    const Eigen::Index both = std::min(unit.size(), rest.size());
    out.along = unit.head(both).dot(rest.head(both));
    rest.head(both) -= out.along * unit.head(both);
  }
  out.beside = std::sqrt(std::max(0.0, rest.squaredNorm() - out.inside.squaredNorm()));
  return out;
}

SearchResult search_directions(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                               const loop::Isotropy& isotropy, std::vector<Eigen::VectorXd> starts, double partner,
                               double amplitude, double nudge, const std::vector<Eigen::VectorXd>& known,
                               const DirectionOptions& options, bool are_isolated) {
  const Search search{system, base, group, isotropy, amplitude, options};
  SearchResult out;
  std::vector<Eigen::VectorXd> taken = known;
  const auto is_taken = [&](const Eigen::VectorXd& v) {
    return std::any_of(taken.begin(), taken.end(),
                       [&](const Eigen::VectorXd& other) { return group.image(v, other, same_direction) != 0; });
  };
  for (std::size_t n = 0; n < starts.size(); ++n) {
    bool is_known = false;
    auto orbit = search.settle(Eigen::VectorXd(starts[n]), base.period, is_taken, &is_known);
    if (!orbit && !is_known) ++out.lost;
    if (!orbit) continue;
    if (!search.is_isolated(*orbit, nudge, is_taken)) {
      orbit = are_isolated ? search.isolated_by_symmetry(*orbit, nudge, is_taken) : std::nullopt;
      if (!orbit) ++out.not_isolated;
      if (!orbit) continue;
    }
    taken.push_back(orbit->coordinates);
    // Where terms of third order decide they change their sign with it: the opposite direction is one too, along which
    // the period changes the other way.
    if (group.constant()) starts.emplace_back(-orbit->coordinates);
    if (partner > 0.0) starts.push_back(Eigen::Rotation2Dd(partner).toRotationMatrix() * orbit->coordinates);
    out.found.push_back(std::move(*orbit));
  }
  return out;
}

bool is_born_beyond(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                    const loop::Isotropy& isotropy, loop::Loop orbit, double amplitude,
                    const std::vector<Eigen::VectorXd>& known, const DirectionOptions& options) {
  for (int n = 0; n < most_halvings; ++n) {
    const Eigen::VectorXd inside = gap_between(base, orbit, group, {}).inside;
    if (inside.norm() <= amplitude) return false;
    Eigen::VectorXd aside = inside;
    for (const Eigen::VectorXd& v : known)
      for (const Action& action : group.actions()) {
        const Eigen::VectorXd image = action.matrix * v;
        const Eigen::VectorXd later = (group.turn() * image).normalized();
        const Eigen::VectorXd rest = inside - image.dot(inside) * image - later.dot(inside) * later;
        if (rest.norm() < aside.norm()) aside = rest;
      }
    if (aside.norm() < touching * inside.norm()) return true;
    const loop::Tangent off = loop::with_cutoff(group.vector_at(aside.normalized()), orbit.cutoff, orbit.dimension);
    const corrector::Result nearer =
        held_orbit(system, loop::moved(orbit, off, -0.5 * aside.norm()), {off}, {}, isotropy, options.corrector);
    if (!nearer.converged()) return false;
    orbit = nearer.loop;
  }
  return false;
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
    if (v.norm() > least_length) out.push_back(v.normalized());
  }
  return out;
}

}  // namespace orbweaver::bifurcation
