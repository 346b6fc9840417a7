#include "searched_directions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "angle_search.hpp"
#include "born_orbit.hpp"
#include "leaving.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "reduced_field.hpp"
#include "search.hpp"
#include "standard_image.hpp"
#include "twin_order.hpp"
#include "whole_way.hpp"

namespace orbweaver::bifurcation {

namespace {

/// The size that terms of order q - 2, which alone fix the angle in a plane, must have at an amplitude for a search:
/// ten thousand times the loss's tolerance, since their coefficient may be small.
constexpr double fixing_term = 1e-6;
/// Amplitudes of a search, relative to the orbit's where that is below 1: for q > 4 the first is between these two, and
/// is doubled while below the third. Smaller ones leave the angle to the loss's tolerance, larger ones are not near.
constexpr double least_amplitude = 0.01;
constexpr double largest_first_amplitude = 0.1;
constexpr double largest_amplitude = 0.3;
/// About an equilibrium a search goes so many times further out than the amplitude at which families must be there: one
/// that was born just below has left the family that it was born on.
constexpr double beyond_births = 2.0;
/// About an equilibrium, where orbits are found and some starts lead nowhere: amplitudes that are looked at besides.
constexpr int most_further = 2;
/// About an equilibrium, radians between a direction that the reduced field predicts and the orbit found from it.
constexpr double near_predicted = 0.05;
/// How far beside a direction its neighbours are sought: in a plane a tenth of the way to the next image (in parts of
/// half that way), elsewhere so many radians. Not measured.
constexpr double nudge_in_plane = 0.2;
constexpr double nudge_in_space = 0.03;
/// Relative to the equilibrium's: periods of orbits of amplitude 0.01 differ by that or its square, or not at all.
constexpr double same_period = 1e-7;

// An amplitude and its doubles.
std::vector<double> amplitudes_from(double first) {
  std::vector<double> out{first};
  for (double r = 2.0 * first; r < largest_amplitude; r *= 2.0) out.push_back(r);
  return out;
}

// The amplitudes to search at about an orbit.
std::vector<double> search_amplitudes(int q, const loop::Loop& base) {
  const double scale = std::min(1.0, loop::rms_amplitude(base));
  const double least =
      std::clamp(q > 4 ? std::pow(fixing_term, 1.0 / (q - 2)) : 0.0, least_amplitude, largest_first_amplitude);
  std::vector<double> out = q > 2 ? amplitudes_from(least) : std::vector{least};
  for (double& r : out) r *= scale;
  return out;
}

/// Those found about an equilibrium: by period, the longest first.
std::vector<Direction> about_equilibrium(const systems::Structure& system, const KernelActions& group,
                                         const loop::Loop& base, const SearchResult& result, double amplitude) {
  const double tolerance = found_tolerance * amplitude;
  std::vector<std::pair<loop::Loop, Direction>> found;
  for (const FoundOrbit& orbit : result.found) {
    loop::Loop loop = standard_image(system, group, orbit.loop, tolerance);
    Direction direction = whole_way(base, loop);
    direction.isotropy = loop::find_isotropy(system, loop, tolerance, group.denominator());
    found.emplace_back(std::move(loop), counted(group, orbit.coordinates, std::move(direction)));
  }
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    if (std::abs(a.first.period - b.first.period) > same_period * base.period) return a.first.period > b.first.period;
    return starts_further(a.first, b.first, tolerance);
  });
  std::vector<Direction> out;
  for (auto& [loop, direction] : found) out.push_back(std::move(direction));
  return out;
}

/// Whether an image of the direction is one of these.
bool is_near_any(const KernelActions& group, const Eigen::VectorXd& v, const std::vector<Eigen::VectorXd>& others) {
  return std::any_of(others.begin(), others.end(),
                     [&](const Eigen::VectorXd& other) { return group.image(v, other, near_predicted) != 0; });
}

/// Directions at which orbits were found, less those along `lines` and images of others, as the whole way from the base
/// to each: the smaller the term that fixes the angle, the nearer a first orbit must be guessed.
std::vector<Direction> by_angles(const systems::System& system, const KernelActions& group, const loop::Loop& base,
                                 const loop::Isotropy& kept, int q, const std::vector<Eigen::VectorXd>& lines,
                                 const DirectionOptions& options) {
  const double scale = std::min(1.0, loop::rms_amplitude(base));
  const AnglesFound angles = search_angles(system, base, group, kept, q, scale, options);
  if (!angles.decided())
    throw UndecidedError(
        fmt::format("a kernel of dimension 2 (q = {}): at amplitude {:.2g} what decides in which directions families "
                    "leave is {:.1e}, "
                    "and rounding {:.1e}",
                    q, angles.amplitude, angles.force, angles.noise));
  std::vector<Direction> out;
  std::vector<Eigen::VectorXd> taken = lines;
  for (const FoundOrbit& orbit : angles.found) {
    if (is_near_any(group, orbit.coordinates, taken)) continue;
    taken.push_back(orbit.coordinates);
    Direction direction = whole_way(base, orbit.loop, orbit.opposite);
    direction.isotropy =
        loop::find_isotropy(system.structure(), orbit.loop, found_tolerance * angles.amplitude, group.denominator());
    direction.both_sides = has_other_sides(group, orbit.coordinates);
    direction.is_hidden = !angles.is_visible();
    out.push_back(std::move(direction));
  }
  return out;
}

/// Whether the orbit as far along the opposite direction stands before the one found. Without it, the base does.
bool leads_to_second(const systems::System& system, const KernelActions& group, const loop::Loop& base,
                     const loop::Isotropy& kept, const FoundOrbit& orbit, double amplitude,
                     const DirectionOptions& options) {
  const Eigen::VectorXd opposite = -orbit.coordinates;
  const corrector::Result result =
      born_orbit(system, base, group.vector_at(opposite), kept, amplitude, options.corrector);
  std::vector<FoundOrbit> sides{orbit, {opposite, 0.0, result.converged() ? result.loop : base}};
  put_in_order(system, sides);
  return sides.front().coordinates == opposite;
}

/// Whether orbits were found near all these, or lines of symmetry lie there.
bool all_are_found(const KernelActions& group, const std::vector<Eigen::VectorXd>& vectors, const SearchResult& result,
                   const std::vector<Eigen::VectorXd>& lines) {
  return std::all_of(vectors.begin(), vectors.end(), [&](const Eigen::VectorXd& v) {
    return is_near_any(group, v, lines) ||
           std::any_of(result.found.begin(), result.found.end(),
                       [&](const auto& orbit) { return group.image(v, orbit.coordinates, near_predicted) != 0; });
  });
}

}  // namespace

Directions searched_directions(const systems::System& system, const KernelActions& group, const loop::Loop& base,
                               const std::vector<Eigen::VectorXd>& lines, const DirectionOptions& options) {
  const bool plane = group.dimension() == 2;
  const int q = plane ? group.rotations() : 1;
  // What every vector of the kernel keeps: that of one without symmetry.
  const Eigen::VectorXd generic = Eigen::VectorXd::LinSpaced(group.dimension(), 1.0, std::sqrt(2.0)).array().sin();
  const loop::Isotropy kept =
      isotropy_along(system.structure(), group, base, group.vector_at(generic.normalized()), options);
  const bool by_angle =
      plane && q >= 2 && (lines.empty() || q == 2) && !group.constant() && system.structure().conservative();
  if (by_angle && q >= least_weak_resonance) return {by_angles(system, group, base, kept, q, lines, options)};
  Directions out;
  const double nudge = plane ? nudge_in_plane * std::numbers::pi / q : nudge_in_space;
  const int expected = plane && q > 2 ? (q % 2 == 0 ? 2 : 1) : 0;
  SearchResult best;
  int further = 0;
  double amplitude = 0.0;
  const bool constant = group.constant();
  for (const double r : constant ? amplitudes_from(beyond_births * options.amplitude) : search_amplitudes(q, base)) {
    const auto search = [&](std::vector<Eigen::VectorXd> starts, bool are_isolated = false) {
      return search_directions(system, base, group, kept, std::move(starts), expected == 2 ? std::numbers::pi / q : 0.0,
                               r, nudge, lines, options, are_isolated);
    };
    std::vector<Eigen::VectorXd> starts = start_directions(group.dimension(), q, options.seeds);
    SearchResult result;
    bool is_complete = false;
    if (constant) {
      const ReducedZeros likely = reduced_zeros(system, base, group, r);
      result = search(likely.vectors, likely.is_complete);
      is_complete =
          likely.is_complete && result.not_isolated == 0 && all_are_found(group, likely.vectors, result, lines);
      starts.insert(starts.begin(), likely.vectors.begin(), likely.vectors.end());
    }
    if (!is_complete) result = search(std::move(starts));
    const auto count = static_cast<int>(result.found.size());
    const int lost = result.lost;
    const bool possible = expected == 0 || count <= expected;
    if (amplitude == 0.0 || is_complete || (possible && result.found.size() > best.found.size()) ||
        (constant && result.found.size() == best.found.size() && result.not_isolated < best.not_isolated)) {
      best = possible ? std::move(result) : SearchResult{{}, result.not_isolated + count};
      amplitude = r;
    }
    // Where starts stall, what tells directions apart may be too weak there.
    further = lost > 0 && !best.found.empty() ? further + 1 : 0;
    const bool is_told = is_complete || (best.not_isolated == 0 && (lost == 0 || further > most_further));
    if (constant ? is_told : expected == 0 || static_cast<int>(best.found.size()) == expected) break;
  }
  if (constant)
    std::erase_if(best.found, [&](const FoundOrbit& orbit) {
      return is_born_beyond(system, base, group, kept, orbit.loop, options.amplitude, lines, options);
    });
  // Of q = 2 what decides has as many maxima as minima: an even number of lines. Those that symmetry singles out may be
  // of one kind, with others between them.
  const bool is_open = q == 2 && (best.found.size() % 2 != 0 || !lines.empty());
  if (by_angle && (static_cast<int>(best.found.size()) < std::max(expected, 1) || is_open)) try {
      out.found = by_angles(system, group, base, kept, q, lines, options);
      if (q == 2 || static_cast<int>(out.found.size()) == expected) return out;
      out.found.clear();
    } catch (const UndecidedError& error) {
      if (best.found.empty() && lines.empty()) throw;
      out.doubt = error.what();
    }
  const std::string seen = fmt::format(
      "a kernel of dimension {} (q = {}): {} directions found at amplitude {:.2g}, {} where orbits are not isolated",
      group.dimension(), q, best.found.size(), amplitude, best.not_isolated);
  out.not_isolated = best.not_isolated;
  if (lines.empty() && best.found.empty() && !(constant && best.not_isolated > 0))
    throw core::NumericalError(seen + "; they form a continuum, or the loss does not tell them apart");
  if ((best.not_isolated > 0 && !constant) || static_cast<int>(best.found.size()) < expected) core::log_warning(seen);
  // Where all that there can be are found, what is not isolated is none of them.
  const bool are_all = expected > 0 && static_cast<int>(best.found.size()) == expected;
  if (best.not_isolated > 0 && !are_all && out.doubt.empty()) out.doubt = seen;
  if (constant) {
    out.found = about_equilibrium(system.structure(), group, base, best, amplitude);
    return out;
  }
  put_in_order(system, best.found);
  for (const FoundOrbit& orbit : best.found) {
    Direction& direction = out.found.emplace_back(
        Direction{base, leaving_along(group.vector_at(orbit.coordinates), orbit.along, options.family),
                  loop::find_isotropy(system.structure(), orbit.loop, found_tolerance * amplitude, group.denominator()),
                  has_other_sides(group, orbit.coordinates), amplitude});
    if (direction.both_sides && leads_to_second(system, group, base, kept, orbit, amplitude, options))
      direction.tangent *= -1.0;
  }
  return out;
}

}  // namespace orbweaver::bifurcation
