#include "orbweaver/bifurcation/directions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "angle_search.hpp"
#include "born_orbit.hpp"
#include "fixed_spaces.hpp"
#include "kernel_actions.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "reduced_field.hpp"
#include "search.hpp"
#include "standard_image.hpp"
#include "twin_order.hpp"
#include "whole_way.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double same_line = 3e-3;  // radians; distinct lines of a finite group are much further apart
/// Radians between an oscillation and its images, as far apart as those that a search tells apart; and what is seen of
/// a harmonic in a direction of unit length, known to the amplitude of a search.
constexpr double same_image = 0.02;
constexpr double visible_harmonic = 1e-3;
constexpr int largest_kernel = 8;
/// How far from a crossing, in parts of the orbit where that is below 1, it is asked how families go through it, and
/// how far these may lie along the base's own family, in parts of their way in the kernel. Not measured.
constexpr double tilt_amplitude = 3e-3;
constexpr double steepest = 10.0;
/// Entries of unit directions and coordinates of orbits that are less apart do not decide signs and phases: kernel
/// vectors are good to that. Either choice starts the same family.
constexpr double visible = 1e-6;
/// The amplitude at which base and direction are looked at together, and what a symmetry may be off there, in the
/// base's tolerances. What the direction breaks is off by the order of the amplitude: neither decides.
constexpr double probe_amplitude = 0.1;
constexpr double probe_tolerance = 10.0;
/// A unit vector whose part in a space is longer than 1 less this lies in it: 0.8 degrees.
constexpr double outside = 1e-4;
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

// What decides which of several images of one direction is reported, and in which order directions are listed.
struct Rank {
  int reversor = std::numeric_limits<int>::max();  // place of the first one that is kept
  double phase = 0.0;                              // its phase
  std::vector<std::pair<int, double>> kept;        // equivariances: place and shift

  [[nodiscard]] auto tie() const { return std::tie(reversor, phase, kept); }
};

Rank rank_of(const KernelActions& group, const systems::Structure& system, const Eigen::VectorXd& v) {
  Rank rank;
  for (const Action& a : group.actions()) {
    if (!a.maps(v, v)) continue;
    const std::pair<int, double> here{a.declared, a.element.shift()};
    if (!a.element.reversing)
      rank.kept.push_back(here);
    else if (a.declared < static_cast<int>(system.reversors.size()))
      std::tie(rank.reversor, rank.phase) = std::min(std::pair{rank.reversor, rank.phase}, here);
  }
  std::sort(rank.kept.begin(), rank.kept.end());
  return rank;
}

// z(t) of the loop's first coordinate, `fraction` of a period after its start.
double first_coordinate(const loop::Loop& loop, double fraction) {
  return loop::state_at(loop, fraction * loop.period).front();
}

// The first coordinate that moves at s = 0 does so upwards: of two sides that are images of one another either will do.
double upward(const loop::Loop& direction) {
  const std::vector<double> at_start = loop::state_at(direction, 0.0);
  for (const std::vector<double>* numbers : {&at_start, &direction.modes})
    for (const double v : *numbers)
      if (std::abs(v) > visible) return v > 0.0 ? 1.0 : -1.0;
  return 1.0;
}

// One of the born orbits' isotropies: what base and direction have in common.
loop::Isotropy isotropy_along(const systems::Structure& system, const KernelActions& group, const loop::Loop& base,
                              const loop::Tangent& along, const DirectionOptions& options) {
  return loop::find_isotropy(system, loop::moved(base, along, probe_amplitude),
                             probe_tolerance * options.symmetry_tolerance, group.denominator());
}

bool has_other_sides(const KernelActions& group, const Eigen::VectorXd& v) {
  if (group.constant()) return group.image(v, -v, same_line) == 0;
  return std::none_of(group.actions().begin(), group.actions().end(), [&](const Action& a) { return a.maps(v, -v); });
}

// What an equilibrium's direction has besides.
Direction counted(const KernelActions& group, const Eigen::VectorXd& v, Direction direction) {
  if (!group.constant()) return direction;
  direction.images = group.images(v, same_image);
  direction.repetitions = group.times_around(v, visible_harmonic);
  return direction;
}

// A unit vector of the kernel, and `along` times as far along the base's own family; of length 1.
loop::Tangent leaving_along(loop::Tangent in_kernel, double along, const loop::Tangent& family) {
  if (family.modes.empty() || along == 0.0) return in_kernel;
  double square = 0.0;
  for (const double v : family.modes) square += v * v;
  const double share = along / std::sqrt(square);
  for (std::size_t n = 0; n < in_kernel.modes.size(); ++n) in_kernel.modes[n] += share * family.modes[n];
  in_kernel.normalize();
  return in_kernel;
}

/// The way in which a family goes through a crossing, both its sides being other orbits: it leaves along the base's own
/// family too, by so much as orbits to both sides say. The direction alone where they are not found.
loop::Tangent tilted(const systems::System& system, const Direction& direction, const std::vector<double>& family,
                     const DirectionOptions& options) {
  const Eigen::Map<const Eigen::VectorXd> inside(direction.tangent.modes.data(),
                                                 static_cast<Eigen::Index>(direction.tangent.modes.size()));
  Eigen::VectorXd aside = Eigen::Map<const Eigen::VectorXd>(family.data(), static_cast<Eigen::Index>(family.size()));
  aside -= inside.dot(aside) * inside;
  if (!(aside.norm() > outside)) return direction.tangent;
  aside.normalize();
  const double amplitude = tilt_amplitude * std::min(1.0, loop::rms_amplitude(direction.base));
  double along = 0.0;
  for (const double side : {1.0, -1.0}) {
    loop::Tangent way = direction.tangent;
    way *= side;
    const corrector::Result result =
        born_orbit(system, direction.base, way, direction.isotropy, amplitude, options.corrector);
    if (!result.converged()) return direction.tangent;
    const std::vector<double> there = loop::with_cutoff(result.loop, direction.base.cutoff).modes;
    const Eigen::VectorXd gap = Eigen::Map<const Eigen::VectorXd>(there.data(), aside.size()) -
                                Eigen::Map<const Eigen::VectorXd>(direction.base.modes.data(), aside.size());
    along += side * aside.dot(gap) / (2.0 * amplitude);
  }
  if (!(std::abs(along) < steepest)) return direction.tangent;
  loop::Tangent family_way;
  family_way.modes.assign(aside.data(), aside.data() + aside.size());
  return leaving_along(direction.tangent, along, family_way);
}

// The direction of a fixed line: made exactly symmetric, started where the reversor has phase 0.
Direction direction_along(const systems::System& of, const KernelActions& group, const loop::Loop& base,
                          const Eigen::VectorXd& v, const DirectionOptions& options) {
  const systems::Structure& system = of.structure();
  const loop::Loop vector = loop::perturbation(base, group.vector_at(v));
  loop::Loop mean = vector;
  std::fill(mean.modes.begin(), mean.modes.end(), 0.0);
  for (const Action& a : group.actions())
    if (a.maps(v, v))
      mean = loop::moved(std::move(mean), {loop::transformed_perturbation(vector, a.element).modes, {}}, 1.0);

  const Rank rank = rank_of(group, system, v);
  double start = 0.0;
  const bool is_reversible = rank.reversor < std::numeric_limits<int>::max();
  if (is_reversible) {
    // Of the two instants on the fixed set the one with the larger first coordinate.
    start = 0.5 * rank.phase;
    if (first_coordinate(base, start + 0.5) > first_coordinate(base, start) + visible) start += 0.5;
  }
  Direction out;
  out.base = loop::time_shifted(base, start);
  mean = loop::time_shifted(mean, start);
  double length = 0.0;
  for (const double c : mean.modes) length += c * c;
  out.tangent.modes = mean.modes;
  out.tangent *= 1.0 / std::sqrt(length);
  out.both_sides = has_other_sides(group, v);
  const int rising = out.both_sides ? rising_side(of, out.base, out.tangent, is_reversible) : 0;
  out.tangent *= rising != 0 ? rising : upward(mean);
  out.isotropy = isotropy_along(system, group, out.base, out.tangent, options);
  // At a crossing of the third order families may leave along the base itself.
  if (out.both_sides && !group.constant() && !options.family.empty() && group.times() != 3)
    out.tangent = tilted(of, out, loop::time_shifted(loop::perturbation(base, options.family), start).modes, options);
  return counted(group, v, std::move(out));
}

// A direction less its part along the time shift, which orbits that are found have none of.
loop::Tangent across_time(const loop::Loop& base, loop::Tangent direction) {
  core::require(direction.modes.size() == base.modes.size(),
                "the family's direction needs the size of the base's modes");
  const loss::Unknowns all{loop::Subspace(base.dimension, base.cutoff, {}), {}};
  const std::vector<double> shift = all.tangent_of(all.time_shift_direction(base)).modes;
  double along = 0.0;
  double square = 0.0;
  for (std::size_t n = 0; n < shift.size(); ++n) {
    along += shift[n] * direction.modes[n];
    square += shift[n] * shift[n];
  }
  if (square == 0.0) return direction;
  for (std::size_t n = 0; n < shift.size(); ++n) direction.modes[n] -= along / square * shift[n];
  return direction;
}

// The lines that a symmetry group fixes; about an equilibrium also the oscillations (planes that time shifts turn) that
// equivariances alone single out.
std::vector<Eigen::VectorXd> fixed_lines(const KernelActions& group) {
  std::vector<Eigen::MatrixXd> matrices;
  for (const Action& a : group.actions()) matrices.push_back(a.matrix);
  const std::vector<Eigen::MatrixXd> spaces = fixed_spaces(matrices, group.dimension());
  std::vector<Eigen::VectorXd> lines;
  for (const Eigen::MatrixXd& space : spaces)
    if (space.cols() == 1) lines.emplace_back(space.col(0));
  if (!group.constant()) return lines;
  const auto contains = [](const Eigen::MatrixXd& space, const Eigen::VectorXd& v) {
    return (space.transpose() * v).norm() > 1.0 - outside;
  };
  for (const Eigen::MatrixXd& space : spaces)
    if (space.cols() == 2 && contains(space, (group.turn() * space.col(0)).normalized()) &&
        std::none_of(lines.begin(), lines.end(), [&](const Eigen::VectorXd& v) { return contains(space, v); }))
      lines.emplace_back(space.col(0));
  return lines;
}

struct Line {
  Rank rank;
  Eigen::VectorXd vector;
};

// One of each set of images, the one of lowest rank.
std::vector<Line> representatives(const KernelActions& group, const systems::Structure& system,
                                  const std::vector<Eigen::VectorXd>& lines) {
  std::vector<Line> ranked;
  for (const Eigen::VectorXd& v : lines) ranked.push_back({rank_of(group, system, v), v});
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Line& a, const Line& b) { return a.rank.tie() < b.rank.tie(); });
  std::vector<Line> out;
  for (const Line& line : ranked)
    if (std::none_of(out.begin(), out.end(),
                     [&](const Line& other) { return group.image(line.vector, other.vector, same_line) != 0; }))
      out.push_back(line);
  return out;
}

// The directions of lines, twins in the order of what the crossing's orbit does where they are symmetric: the phases of
// their reversor hang on the start of the base.
std::vector<Direction> along_lines(const systems::System& system, const KernelActions& group, const loop::Loop& base,
                                   const std::vector<Line>& lines, const DirectionOptions& options) {
  std::vector<Direction> out;
  std::vector<std::vector<double>> numbers;
  for (const Line& line : lines) {
    out.push_back(direction_along(system, group, base, line.vector, options));
    numbers.push_back(at_symmetric_instants(system, out.back().base));
  }
  if (group.constant()) return out;
  const auto are_twins = [&](std::size_t a, std::size_t b) {
    return lines[a].rank.reversor == lines[b].rank.reversor && lines[a].rank.kept == lines[b].rank.kept;
  };
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t l = 0; l < order.size(); ++l)  // twins change places with each other only
    for (std::size_t m = l + 1; m < order.size(); ++m)
      if (are_twins(order[l], order[m]) && stands_before(numbers[order[m]], numbers[order[l]], of_crossings))
        std::swap(order[l], order[m]);
  std::vector<Direction> sorted;
  for (const std::size_t n : order) sorted.push_back(std::move(out[n]));
  return sorted;
}

// How many of a plane's symmetries are rotations: q of the sector e^{2 pi i j / q}.
int rotations(const KernelActions& group) {
  std::vector<Eigen::MatrixXd> distinct;
  for (const Action& a : group.actions())
    if (a.matrix.determinant() > 0.0 && std::none_of(distinct.begin(), distinct.end(), [&](const Eigen::MatrixXd& m) {
          return (m - a.matrix).norm() < same_element;
        }))
      distinct.push_back(a.matrix);
  return static_cast<int>(distinct.size());
}

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

Directions searched(const systems::System& system, const KernelActions& group, const loop::Loop& base,
                    const std::vector<Eigen::VectorXd>& lines, const DirectionOptions& options) {
  const bool plane = group.dimension() == 2;
  const int q = plane ? rotations(group) : 1;
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
  if (lines.empty() && best.found.empty())
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

}  // namespace

loop::Tangent way_to_side(const loop::Tangent& tangent, const loop::Tangent& opposite, int side) {
  if (side > 0) return tangent;
  loop::Tangent out = opposite.empty() ? tangent : opposite;
  if (opposite.empty()) out *= -1.0;
  return out;
}

Directions directions(const systems::System& system, const loop::Loop& base, const loop::Isotropy& isotropy,
                      const std::vector<loop::Tangent>& kernel, const DirectionOptions& given) {
  loop::validate(base);
  core::require(base.time_map.is_identity(), "directions need a base loop that runs evenly in time");
  core::require(!kernel.empty() && kernel.size() <= largest_kernel, "directions need a kernel of dimension 1 to 8");
  const systems::Structure& structure = system.structure();
  DirectionOptions options = given;
  if (!options.family.empty()) options.family = across_time(base, options.family);
  const KernelActions group(structure, base, kernel, options);
  for (const loop::SymmetryElement& g : isotropy)
    if (std::none_of(group.actions().begin(), group.actions().end(),
                     [&](const Action& a) { return a.element.name == g.name; }))
      throw core::NumericalError(
          fmt::format("the base loop of a kernel does not have the symmetry {} of its orbit to "
                      "{:.2g}, with any phase that its other symmetries allow",
                      g.name, options.symmetry_tolerance));
  const std::vector<Line> lines = representatives(group, structure, fixed_lines(group));
  Directions out{along_lines(system, group, base, lines, options)};
  // A single oscillation, a single vector, and a plane with rotations and reflections have no others.
  const bool complete = kernel.size() == 1 || (kernel.size() == 2 && group.constant()) ||
                        (kernel.size() == 2 && !lines.empty() && rotations(group) > 2);
  if (complete) return out;
  std::vector<Eigen::VectorXd> known;
  for (const Line& line : lines) known.push_back(line.vector);
  Directions others = searched(system, group, base, known, options);
  others.found.insert(others.found.begin(), std::make_move_iterator(out.found.begin()),
                      std::make_move_iterator(out.found.end()));
  return others;
}

Directions equilibrium_directions(const systems::System& system, std::span<const double> point,
                                  const starts::SharedPeriod& shared, int cutoff, const DirectionOptions& options) {
  const loop::Loop base = loop::constant_loop(point, shared.period, cutoff);
  core::require(shared.kernel.rows() == base.dimension, "oscillations need the dimension of the equilibrium");
  core::require(
      shared.harmonics.size() == static_cast<std::size_t>(shared.kernel.cols()) &&
          std::all_of(shared.harmonics.begin(), shared.harmonics.end(), [&](int k) { return k >= 1 && k <= cutoff; }),
      "oscillations need a harmonic each, of the loops' cutoff at most");
  std::vector<loop::Tangent> vectors;
  for (Eigen::Index c = 0; c < shared.kernel.cols(); ++c)
    for (const std::complex<double> phase : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      const int harmonic = shared.harmonics[static_cast<std::size_t>(c)];
      loop::Loop v = base;
      std::fill(v.modes.begin(), v.modes.end(), 0.0);
      for (int i = 0; i < v.dimension; ++i) {
        v.cosine(harmonic, i) = (phase * shared.kernel(i, c)).real();
        v.sine(harmonic, i) = -(phase * shared.kernel(i, c)).imag();
      }
      vectors.push_back({v.modes, {}});
    }
  return directions(system, base, {}, vectors, options);
}

}  // namespace orbweaver::bifurcation
