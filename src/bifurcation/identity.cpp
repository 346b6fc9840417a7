#include "orbweaver/bifurcation/identity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::bifurcation {

namespace {

using continuation::Orbit;
using continuation::same_within;

/// How far outside the chord's ends a projection may lie, and how far from the chord an orbit between its ends can be,
/// in parts of the chord. Wide on purpose: further corrections decide, these only end hopeless ones.
constexpr double beyond = 0.3;
constexpr double away = 1.0;
/// Corrections of a phase that was off by the chord's error, each to its square (four squarings of 0.1 are rounding),
/// while the distance falls to this share: what separates two families stays.
constexpr int corrections = 4;
constexpr double phase_progress = 0.3;
/// Tolerances that an orbit at the chord's end, where the bulge allows nothing, may be off it. Not measured.
constexpr double off_at_ends = 10.0;
/// A repetition must be exact to this share of the amplitude too, or small orbits would all repeat.
constexpr double repeated = 1e-3;
/// A smooth family leaves the chord by about this share of it times position (1 - position); further off Newton's
/// method has gone over to a neighbouring family.
constexpr double bulge = 0.8;
/// An orbit further off the chord than so many bulges is no orbit of the family, whatever Newton's method says there.
constexpr double far_off = 2.0;
/// In parts of the distance between two orbits, by how much a parameter may leave the range between theirs. Not
/// measured.
constexpr double out_of_range = 0.5;

bool is_between(double a, double b, double x, double widening) {
  const double margin = 0.5 * std::abs(b - a) + widening;
  return x >= std::min(a, b) - margin && x <= std::max(a, b) + margin;
}

Eigen::VectorXd difference(const loss::Unknowns& unknowns, const loop::Loop& from, const loop::Loop& to) {
  const std::vector<double> u = unknowns.difference(from, to);
  return Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size()));
}

loop::Loop moved(const loss::Unknowns& unknowns, const loop::Loop& base, const Eigen::VectorXd& u) {
  return unknowns.moved(base, std::span<const double>(u.data(), static_cast<std::size_t>(u.size())));
}

// The time shift as a unit vector of unknowns; empty where the subspace does not contain it.
Eigen::VectorXd shift_direction(const loss::Unknowns& unknowns, const loop::Loop& at) {
  const std::vector<double> u = unknowns.time_shift_direction(at);
  const Eigen::VectorXd direction = Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size()));
  if (direction.norm() <= loss::Unknowns::least_time_shift * loop::rms_amplitude(at)) return {};
  return direction.normalized();
}

double distance_between(const loop::Loop& a, const loop::Loop& b, double aligned_distance) {
  double distance = std::hypot(aligned_distance, a.period / b.period - 1.0);
  for (std::size_t n = 0; n < std::min(a.parameters.size(), b.parameters.size()); ++n)
    distance = std::hypot(distance, a.parameters[n] - b.parameters[n]);
  return distance;
}

using Hold = systems::FamilyScalars::Hold;

// What moves along a family beside its loops.
std::vector<loss::Scalar> scalars_of(const systems::System& system) {
  std::vector<loss::Scalar> scalars{loss::Scalar::period()};
  for (const std::string& name : system.family_scalars().free) scalars.push_back(loss::Scalar::of_parameter(name));
  return scalars;
}

// The family near the chord from a to b, in the modes of one cutoff and one time map.
class Chord {
 public:
  Chord(const systems::System& system, const Orbit& a, const Orbit& b, const loop::Isotropy& isotropy,
        const IdentityOptions& options)
      : _system(system), _isotropy(isotropy), _options(options), _a(a.loop), _b(b.loop) {
    resize(std::max(a.loop.cutoff, b.loop.cutoff));
    if (!may_shift()) return;
    _b = in_phase_with(_first, _second);
    resize(_first.cutoff);
  }

  [[nodiscard]] double length() const {
    return distance_between(_first, _second, loop::mean_distance(_first, _second));
  }
  [[nodiscard]] const loop::Loop& first() const { return _first; }

  // Where the projection of `x` lies on the chord through `base`, which need not be `first`.
  [[nodiscard]] double position_of(const loop::Loop& x, const loop::Loop& base) const {
    const Eigen::VectorXd direction = chord_at(base);
    return difference(*_unknowns, base, as_here(x)).dot(direction) / direction.squaredNorm();
  }

  // The orbit of the family in the hyperplane across the chord through base + position (b - a).
  [[nodiscard]] corrector::Result correct(loop::Loop base, double position) {
    while (true) {
      const loop::Loop guess = moved(*_unknowns, base, position * chord_at(base));
      const Eigen::MatrixXd conditions = conditions_at(guess);
      corrector::Result result = corrector::correct(_system, guess, *_unknowns,
                                                    loss::Slice(_unknowns->size(), conditions), _options.corrector);
      const int larger = loop::next_cutoff(_first.cutoff);
      if (result.outcome != corrector::Outcome::under_resolved || larger > _options.cutoff_to) return result;
      resize(larger);
      base = loop::with_cutoff(base, larger);
    }
  }

  /// How far an orbit of the family is from the chord's point at `position`, in parts of the chord, time shifts apart.
  [[nodiscard]] double off_chord(const loop::Loop& x, double position) const {
    const loop::Loop place = moved(*_unknowns, _first, position * difference(*_unknowns, _first, _second));
    const loop::Loop here = as_here(x);
    return difference(*_unknowns, place, may_shift() ? in_phase_with(place, here) : here).norm() /
           chord_at(_first).norm();
  }

  [[nodiscard]] loop::Loop as_here(const loop::Loop& x) const {
    return loop::with_time_map(x, _first.time_map, _first.cutoff);
  }

 private:
  [[nodiscard]] bool may_shift() const { return shift_direction(*_unknowns, _first).size() > 0; }

  /// Without that what two loops differ by in phase, which a shift takes away to first order only, passes for a bulge.
  [[nodiscard]] loop::Loop in_phase_with(const loop::Loop& place, const loop::Loop& x) const {
    return as_here(loop::aligned(x, loop::align_in_time(_system.structure(), x, place)));
  }

  void resize(int cutoff) {
    _first = loop::with_cutoff(_a, cutoff);
    _second = loop::with_time_map(_b, _a.time_map, cutoff);
    _unknowns.emplace(loss::Unknowns{loop::Subspace(_a.dimension, cutoff, _isotropy), scalars_of(_system)});
  }

  // One column each: along the chord, the period that is held, the time shift.
  [[nodiscard]] Eigen::MatrixXd conditions_at(const loop::Loop& guess) const {
    std::vector<Eigen::VectorXd> columns{chord_at(guess).normalized()};
    if (_system.family_scalars().hold == Hold::period)
      columns.emplace_back(Eigen::VectorXd::Unit(_unknowns->size(), _unknowns->subspace.size()));
    if (Eigen::VectorXd shift = shift_direction(*_unknowns, guess); shift.size() > 0)
      columns.push_back(std::move(shift));
    Eigen::MatrixXd conditions(_unknowns->size(), static_cast<Eigen::Index>(columns.size()));
    for (Eigen::Index q = 0; q < conditions.cols(); ++q) conditions.col(q) = columns[static_cast<std::size_t>(q)];
    return conditions;
  }

  // b - a without what only shifts the phase.
  [[nodiscard]] Eigen::VectorXd chord_at(const loop::Loop& at) const {
    Eigen::VectorXd chord = difference(*_unknowns, _first, _second);
    const Eigen::VectorXd shift = shift_direction(*_unknowns, at);
    if (shift.size() > 0) chord -= shift.dot(chord) * shift;
    return chord;
  }

  const systems::System& _system;
  const loop::Isotropy& _isotropy;
  const IdentityOptions& _options;
  loop::Loop _a;
  loop::Loop _b;
  loop::Loop _first;
  loop::Loop _second;
  std::optional<loss::Unknowns> _unknowns;
};

Comparison apart(double distance, double position, std::string detail) {
  return {false, distance, position, std::move(detail), true};
}

Comparison undecided(double distance, double position, std::string detail) {
  return {false, distance, position, std::move(detail), false};
}

Comparison compare(const systems::System& system, Chord chord, const loop::Loop& x, const IdentityOptions& options) {
  const systems::Structure& structure = system.structure();
  const double length = chord.length();
  const double tolerance = same_within(x, options.tolerance);
  loop::Alignment alignment = loop::align(structure, x, chord.first(), 2.0 * length + tolerance);
  if (alignment.distance > 2.0 * length + tolerance)
    return apart(alignment.distance, std::nan(""), "far from the neighbours");
  loop::Loop nearest = chord.first();
  double position = 0.0;
  double distance = std::numeric_limits<double>::infinity();
  for (int n = 0; n < corrections; ++n) {
    const loop::Loop moved_x = loop::aligned(x, alignment);
    const double step = chord.position_of(moved_x, nearest);
    position += step;
    if (position < -beyond || position > 1.0 + beyond)
      return apart(alignment.distance, position, "beyond the neighbours");
    if (system.family_scalars().hold == Hold::energy)
      return undecided(alignment.distance, position,
                       "orbits between those of a family that holds the energy are not found");
    const corrector::Result result = chord.correct(nearest, step);
    const double widest = bulge * std::abs(position * (1.0 - position)) * length + off_at_ends * tolerance;
    if (!result.converged() && chord.off_chord(moved_x, position) * length > far_off * widest)
      return apart(alignment.distance, position, "far from the chord");
    if (!result.converged())
      return undecided(alignment.distance, position,
                       fmt::format("no orbit beside it: {} {}", corrector::name_of(result.outcome), result.detail));
    nearest = result.loop;
    alignment = loop::align(structure, x, nearest);
    const double before = distance;
    distance = distance_between(x, nearest, alignment.distance);
    if (distance <= tolerance) {
      const double off = chord.off_chord(nearest, position) * length;
      if (off <= widest) return {true, distance, position, "the same orbit", true};
      return undecided(off, position, "the correction leaves the family");
    }
    if (distance > away * length + tolerance) return apart(distance, position, "far from the family");
    if (distance > phase_progress * before) break;
  }
  return apart(distance, position, "another orbit");
}

}  // namespace

// A parameter that turns between the two goes on by less than their distance.
bool may_lie_between(const Orbit& a, const Orbit& b, const Orbit& x, double widening) {
  const double period = x.loop.period;
  const auto parameter = [](const Orbit& orbit) {
    return orbit.loop.parameters.empty() ? std::numeric_limits<double>::quiet_NaN() : orbit.loop.parameters.front();
  };
  const auto between = [](double first, double second, double value, double margin) {
    return std::isnan(value) || std::isnan(first) || std::isnan(second) || is_between(first, second, value, margin);
  };
  return between(a.loop.period, b.loop.period, period, widening * period) &&
         between(a.energy, b.energy, x.energy, widening * std::abs(x.action) / period) &&
         between(parameter(a), parameter(b), parameter(x),
                 std::max(widening * std::abs(parameter(x)), out_of_range * loop::mean_distance(a.loop, b.loop))) &&
         between(a.action, b.action, x.action, widening * std::abs(x.action));
}

bool same_orbit(const systems::System& system, const loop::Loop& a, const loop::Loop& b, double tolerance) {
  const auto once = [&](const loop::Loop& orbit) {
    const int m = loop::repetitions(orbit, std::min(tolerance, repeated * loop::rms_amplitude(orbit)));
    return m > 1 ? loop::without_repetition(orbit, m) : orbit;
  };
  if (a.parameters.size() != b.parameters.size()) return false;
  const loop::Loop first = once(a);
  const loop::Loop second = once(b);
  const double allowed = same_within(first, tolerance);
  for (std::size_t n = 0; n < a.parameters.size(); ++n)
    if (!(std::abs(a.parameters[n] - b.parameters[n]) <= allowed)) return false;
  if (!(std::abs(first.period / second.period - 1.0) <= allowed)) return false;
  return distance_between(first, second, loop::align(system.structure(), first, second).distance) <= allowed;
}

Comparison same_family(const systems::System& system, const Orbit& a, const Orbit& b, const loop::Isotropy& isotropy,
                       const Orbit& x, const IdentityOptions& options) {
  Orbit primitive = x;
  const double negligible = std::min(options.tolerance, repeated * loop::rms_amplitude(x.loop));
  const int m = options.keeps_repetitions ? 1 : loop::repetitions(x.loop, negligible);
  if (m > 1) {
    primitive.loop = loop::without_repetition(x.loop, m);
    primitive.action /= m;
  }
  if (!may_lie_between(a, b, primitive, options.widening)) {
    Comparison out;
    out.detail = "period, energy, parameter or action out of range";
    return out;
  }
  return compare(system, Chord(system, a, b, isotropy, options), primitive.loop, options);
}

}  // namespace orbweaver::bifurcation
