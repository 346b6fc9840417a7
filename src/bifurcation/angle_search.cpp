#include "angle_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "born_orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "pushed_system.hpp"
#include "twin_order.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Angles in a turn by 2 pi/q at which the push is looked at: a sine needs three, its first harmonics a few more.
constexpr int samples = 8;
/// Amplitudes, in parts of the scale: the first for which guesses along the kernel alone are good enough. They grow as
/// long as orbits are found and lie within 30 degrees of the kernel and the family, by the first of the factors that
/// serves.
constexpr double first[] = {0.01, 0.003, 0.001, 0.0003};
constexpr double growths[] = {1.4, 1.1, 1.03};
/// Orbits behind one another that a guess for the next is made from, besides the base.
constexpr std::size_t remembered = 4;
/// Orbits of a circle that a guess between two of them is made from.
constexpr std::size_t neighbours = 4;
constexpr double farthest_beside = 0.5;
constexpr std::size_t most_circles = 40;
/// A way from one angle to another is halved so often, at most.
constexpr int halvings = 2;
/// The push must exceed its noise so many times for its zeros to be where the family's are. Not measured.
constexpr double clear = 30.0;
/// What pushes at q = 2 grows with the square of the amplitude, at least twofold a circle, or is the same on all.
constexpr double least_growth = 1.3;
/// Accuracy of an angle, in parts of a turn by 2 pi/q.
constexpr double of_angle = 1e-7;

struct Held {
  double push = 0.0;
  loop::Loop loop;
};

/// Orbits of one amplitude, the last a turn from the first: the same orbit, by other roundings.
struct Circle {
  double amplitude = 0.0;
  std::vector<double> angles;
  std::vector<Held> orbits;

  [[nodiscard]] double noise() const { return std::abs(orbits.back().push - orbits.front().push); }
  [[nodiscard]] double force() const {
    double largest_push = 0.0;
    for (const Held& h : orbits) largest_push = std::max(largest_push, std::abs(h.push));
    return largest_push;
  }
  [[nodiscard]] bool is_clear() const { return force() > clear * noise(); }
  [[nodiscard]] AnglesFound summary() const { return {{}, amplitude, force(), noise()}; }
  /// The last one's is the first one's: a zero at the seam is one zero.
  [[nodiscard]] double push(std::size_t n) const { return orbits[n + 1 < orbits.size() ? n : 0].push; }
  [[nodiscard]] int sign_changes() const {
    int changes = 0;
    for (std::size_t n = 0; n + 1 < orbits.size(); ++n)
      if (push(n) * push(n + 1) < 0.0) ++changes;
    return changes;
  }
};

class Plane {
 public:
  Plane(const systems::System& system, const loop::Loop& base, const KernelActions& group,
        const loop::Isotropy& isotropy, const DirectionOptions& options)
      : _system(system, loop::mean_state(base)), _base(base), _group(group), _isotropy(isotropy), _options(options) {}

  [[nodiscard]] static Eigen::VectorXd unit(double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); }

  /// The orbit held at an angle, from a guess that has its part in the kernel there.
  [[nodiscard]] std::optional<Held> held(const loop::Loop& guess) const {
    const std::vector<loop::Tangent> axes{_group.vector_at(Eigen::Vector2d(1, 0)),
                                          _group.vector_at(Eigen::Vector2d(0, 1))};
    const corrector::Result result = held_orbit(_system, guess, axes, {loss::Scalar::of_parameter(PushedSystem::push)},
                                                _isotropy, _options.corrector);
    if (!result.converged()) return std::nullopt;
    return Held{result.parameters.at(0), result.loop};
  }

  [[nodiscard]] loop::Loop beside(double angle, double amplitude) const {
    return loop::moved(_base, _group.vector_at(unit(angle)), amplitude);
  }

  /// The orbit with its part in the kernel turned to another angle.
  [[nodiscard]] loop::Loop turned(const loop::Loop& orbit, double angle, double amplitude) const {
    const Eigen::VectorXd change = amplitude * unit(angle) - gap_between(_base, orbit, _group, {}).inside;
    return loop::moved(orbit, loop::with_cutoff(_group.vector_at(change), orbit.cutoff, orbit.dimension), 1.0);
  }

  [[nodiscard]] bool is_near(const loop::Loop& orbit) const {
    const Gap gap = gap_between(_base, orbit, _group, _options.family.modes);
    return gap.beside <= farthest_beside * (gap.inside.norm() + std::abs(gap.along));
  }

  /// The polynomial in the angle through the orbits of a circle about place `n`.
  [[nodiscard]] loop::Loop between(const Circle& circle, std::size_t n, double angle) const {
    const std::size_t used = std::min(circle.orbits.size(), neighbours);
    const std::size_t from = std::min(n > 1 ? n - 1 : 0, circle.orbits.size() - used);
    const auto angles = std::span(circle.angles).subspan(from, used);
    std::vector<const loop::Loop*> loops;
    for (const Held& orbit : std::span(circle.orbits).subspan(from, used)) loops.push_back(&orbit.loop);
    return loop::weighted_sum(loops, numerics::lagrange_weights({angles.begin(), angles.end()}, angle).value);
  }

  /// The orbit of another amplitude: by the polynomial in it through the base and the last circles' orbits of this
  /// place.
  [[nodiscard]] loop::Loop continued(const std::vector<Circle>& circles, std::size_t place, double amplitude) const {
    const std::size_t used = std::min(circles.size(), remembered);
    const auto last = std::span(circles).last(used);
    std::vector<double> amplitudes{0.0};
    std::vector<const loop::Loop*> loops{&_base};
    for (const Circle& circle : last) {
      amplitudes.push_back(circle.amplitude);
      loops.push_back(&circle.orbits[place].loop);
    }
    return loop::weighted_sum(loops, numerics::lagrange_weights(amplitudes, amplitude).value);
  }

 private:
  PushedSystem _system;
  const loop::Loop& _base;
  const KernelActions& _group;
  const loop::Isotropy& _isotropy;
  const DirectionOptions& _options;
};

/// The orbits at `angles`, each from its guess; none where one is not found or not near.
std::optional<Circle> held_circle(const Plane& plane, double amplitude, std::vector<double> angles,
                                  const std::function<loop::Loop(std::size_t)>& guess) {
  Circle out{amplitude, std::move(angles), {}};
  for (std::size_t a = 0; a < out.angles.size(); ++a) {
    std::optional<Held> held = plane.held(guess(a));
    if (!held || !plane.is_near(held->loop)) return std::nullopt;
    out.orbits.push_back(std::move(*held));
  }
  return out;
}

/// Circles at these angles, up to the first that `is_far`, or as near to that as orbits are found. None is larger than
/// `largest`.
template <class IsFar>
std::vector<Circle> grown(const Plane& plane, double scale, const std::vector<double>& angles, const IsFar& is_far,
                          double largest = std::numeric_limits<double>::infinity()) {
  std::vector<Circle> circles;
  for (const double part : first) {
    auto circle =
        held_circle(plane, part * scale, angles, [&](std::size_t a) { return plane.beside(angles[a], part * scale); });
    if (!circle) continue;
    circles.push_back(std::move(*circle));
    break;
  }
  while (!circles.empty() && circles.size() < most_circles && !is_far(circles.back())) {
    std::optional<Circle> next;
    for (const double factor : growths) {
      const double amplitude = std::min(factor * circles.back().amplitude, largest);
      next =
          held_circle(plane, amplitude, angles, [&](std::size_t a) { return plane.continued(circles, a, amplitude); });
      if (next) break;
    }
    if (!next) break;
    circles.push_back(std::move(*next));
  }
  return circles;
}

/// From an orbit at one angle to the one at another.
std::optional<Held> turned_to(const Plane& plane, const Held& orbit, double from, double to, double amplitude,
                              int halved = 0) {
  std::optional<Held> held = plane.held(plane.turned(orbit.loop, to, amplitude));
  if (held && plane.is_near(held->loop)) return held;
  if (halved == halvings) return std::nullopt;
  const double middle = 0.5 * (from + to);
  const std::optional<Held> there = turned_to(plane, orbit, from, middle, amplitude, halved + 1);
  return there ? turned_to(plane, *there, middle, to, amplitude, halved + 1) : std::nullopt;
}

/// The circle with all its samples: from one to the next, or, where that is too far, each from the base.
std::optional<Circle> completed(const Plane& plane, const Circle& circle, double turn, double scale) {
  Circle out{circle.amplitude, {0.0}, {circle.orbits.front()}};
  std::vector<double> angles;
  for (int n = 0; n <= samples; ++n) angles.push_back(n * turn / samples);
  for (std::size_t n = 1; n < angles.size(); ++n) {
    std::optional<Held> held = turned_to(plane, out.orbits.back(), out.angles.back(), angles[n], out.amplitude);
    if (!held) {
      std::vector<Circle> circles = grown(
          plane, scale, angles, [&](const Circle& c) { return c.amplitude == circle.amplitude; }, circle.amplitude);
      if (circles.empty()) return std::nullopt;
      return std::move(circles.back());
    }
    out.angles.push_back(angles[n]);
    out.orbits.push_back(std::move(*held));
  }
  return out;
}

/// The circle that tells the angles: the last one, or, where orbits have gone over to another family there, the one of
/// the largest push that does.
std::optional<Circle> telling(const Plane& plane, const std::vector<Circle>& circles, double turn, double scale,
                              int q) {
  // Of q = 2 terms of second and of fourth order may weigh alike: four lines then.
  const int most = q == 2 ? 4 : 2;
  std::vector<const Circle*> tried{&circles.back()};
  const auto largest = std::max_element(circles.begin(), circles.end() - 1, [](const Circle& a, const Circle& b) {
    return (a.is_clear() ? a.force() : 0.0) < (b.is_clear() ? b.force() : 0.0);
  });
  if (largest != circles.end() - 1) tried.push_back(&*largest);
  for (const Circle* circle : tried) {
    if (!circle->is_clear()) continue;
    std::optional<Circle> all = completed(plane, *circle, turn, scale);
    if (all && all->is_clear() && all->sign_changes() >= 2 && all->sign_changes() <= most) return all;
  }
  return std::nullopt;
}

/// The orbit with the time shift that brings its part in the kernel opposite to that of `to`.
loop::Loop shifted_opposite(const loop::Loop& base, const KernelActions& group, const FoundOrbit& to,
                            const loop::Loop& orbit, int q) {
  loop::Loop best = orbit;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < q; ++n) {
    const loop::Loop there = loop::time_shifted(orbit, static_cast<double>(n) / q);
    const double same = gap_between(base, there, group, {}).inside.dot(to.coordinates);
    if (!(same < least)) continue;
    least = same;
    best = there;
  }
  return best;
}

}  // namespace

AnglesFound search_angles(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                          const loop::Isotropy& isotropy, int q, double scale, const DirectionOptions& options) {
  core::require(group.dimension() == 2 && q >= 2, "angles are searched in a plane, from q = 2 on");
  const Plane plane(system, base, group, isotropy, options);
  const double turn = 2.0 * std::numbers::pi / q;
  // Of q = 2 there may be four lines, some of them at these angles; and the push may not grow with the amplitude.
  const std::vector<double> few =
      q == 2 ? std::vector{0.0, 0.125 * turn, 0.25 * turn, turn} : std::vector{0.0, 0.25 * turn, turn};
  double before = 0.0;
  const std::vector<Circle> circles = grown(plane, scale, few, [&](const Circle& circle) {
    if (!circle.is_clear()) return false;
    const bool grows = circle.force() > least_growth * std::exchange(before, circle.force());
    return circle.summary().is_plain() || (q == 2 && !grows);
  });
  if (circles.empty()) return {};
  AnglesFound out = circles.back().summary();
  const std::optional<Circle> told = telling(plane, circles, turn, scale, q);
  if (!told) return out;
  const Circle& circle = *told;
  out = circle.summary();
  // Zeros through which the push rises with time, and those through which it falls.
  std::vector<FoundOrbit> rising;
  std::vector<FoundOrbit> falling;
  const int sense = sense_of_time(group);
  for (std::size_t n = 0; n + 1 < circle.orbits.size(); ++n) {
    const numerics::Place from{circle.angles[n], circle.push(n)};
    const numerics::Place to{circle.angles[n + 1], circle.push(n + 1)};
    if (!(from.value * to.value < 0.0)) continue;
    Held last = circle.orbits[n];
    const auto push_at = [&](double angle) {
      std::optional<Held> held = plane.held(plane.turned(plane.between(circle, n, angle), angle, circle.amplitude));
      if (!held) return std::nan("");
      last = std::move(*held);
      return last.push;
    };
    const auto located = numerics::locate_root(push_at, from, to, of_angle * turn);
    if (!located || std::isnan(push_at(located->position))) continue;
    const Gap gap = gap_between(base, last.loop, group, options.family.modes);
    const double length = gap.inside.norm();
    (sense * to.value > 0.0 ? rising : falling).push_back({gap.inside / length, gap.along / length, last.loop, {}});
  }
  out.found = std::move(rising);
  out.found.insert(out.found.end(), std::make_move_iterator(falling.begin()), std::make_move_iterator(falling.end()));
  if (q < least_weak_resonance) put_in_order(system, out.found);
  if (q % 2 == 1 && out.found.size() == 2) {
    out.found.front().opposite = shifted_opposite(base, group, out.found.front(), out.found.back().loop, q);
    out.found.pop_back();
  }
  return out;
}

}  // namespace orbweaver::bifurcation
