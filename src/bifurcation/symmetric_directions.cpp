#include "symmetric_directions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "born_orbit.hpp"
#include "fixed_spaces.hpp"
#include "leaving.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "twin_order.hpp"

namespace orbweaver::bifurcation {

namespace {

/// How far from a crossing, in parts of the orbit where that is below 1, it is asked how families go through it, and
/// how far these may lie along the base's own family, in parts of their way in the kernel. Not measured.
constexpr double tilt_amplitude = 3e-3;
constexpr double steepest = 10.0;
/// Entries of unit directions and coordinates of orbits that are less apart do not decide signs and phases: kernel
/// vectors are good to that. Either choice starts the same family.
constexpr double visible = 1e-6;
/// A unit vector whose part in a space is longer than 1 less this lies in it: 0.8 degrees.
constexpr double outside = 1e-4;

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

}  // namespace

SymmetricDirections symmetric_directions(const systems::System& system, const KernelActions& group,
                                         const loop::Loop& base, const DirectionOptions& options) {
  const std::vector<Line> lines = representatives(group, system.structure(), fixed_lines(group));
  SymmetricDirections out{along_lines(system, group, base, lines, options), {}};
  for (const Line& line : lines) out.lines.push_back(line.vector);
  return out;
}

}  // namespace orbweaver::bifurcation
