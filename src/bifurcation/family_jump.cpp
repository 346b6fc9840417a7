#include "orbweaver/bifurcation/family_jump.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "turning_sense.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Cosine of the angle between the family's direction at `at` and the chord from `from` to `to`, all under one time
/// map.
double along_chord(const continuation::CurvePoint& at, const loop::Loop& from, const loop::Loop& to) {
  const std::size_t size = std::min({at.tangent.modes.size(), from.modes.size(), to.modes.size()});
  double product = 0.0;
  double chord = 0.0;
  double tangent = 0.0;
  for (std::size_t n = 0; n < size; ++n) {
    const double weight = n < static_cast<std::size_t>(from.dimension) ? 1.0 : 0.5;
    const double change = to.modes[n] - from.modes[n];
    product += weight * at.tangent.modes[n] * change;
    chord += weight * change * change;
    tangent += weight * at.tangent.modes[n] * at.tangent.modes[n];
  }
  const double change = (to.period - from.period) / from.period;
  const double slope = at.tangent.period() / from.period;
  return (product + slope * change) / std::sqrt((chord + change * change) * (tangent + slope * slope));
}

/// Of the index's distances from 2 at the ends of a step: what is left where it passes 2, and not where it jumps.
constexpr double at_two = 1e-3;
/// Where it is sought: to this part of the step, by so many orbits at most. A smooth index takes five.
constexpr double narrowest = 1e-6;
constexpr int most_orbits = 20;

/// Lengths of pieces of a curve, in parts of what they have of the chord: those of a curve that turns from it by less
/// than 60 degrees are below 2, and a piece across a gap has more the shorter it is.
constexpr double torn = 4.0;
/// How far from 2 an index may be on either side of a gap: one of -1e10 is 2 on so short a part of a step that no orbit
/// there shows it.
constexpr double told_apart = 100.0;
/// The shortest piece that is looked at, in parts of the chord: gaps narrower than four of them are not seen.
constexpr double shortest_piece = 1e-3;

/// Pieces that are looked at in any case, the step halved three times: a gap beside which the families bend towards one
/// another makes no half of the step much longer than the other.
constexpr double longest_piece = 0.125;
/// Of the length that a piece has for its part of the chord: by less the two halves of a smooth piece differ.
constexpr double uneven = 0.2;

constexpr TestFunction index_two() { return {TestFunction::Kind::sector, {1, 0}}; }

/// The curve between two orbits.
struct Step : continuation::FamilyCurve {
  Step(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
       const continuation::Options& options, const KnownStability& from, const KnownStability& to)
      : FamilyCurve(system, isotropy, options) {
    add(0.0, from.orbit.loop);
    add(1.0, to.orbit.loop);
  }
};

/// Whether the curve between the orbits is there, and the index comes to 2 on it.
bool has_index_two_between(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                           const continuation::Options& options, const KnownStability& from, const KnownStability& to) {
  Step step(system, isotropy, options, from, to);
  const auto value_of = [&](const spectrum::Stability& s) {
    return evaluate(index_two(), system->structure(), s).value;
  };
  const numerics::Place before{0.0, value_of(from.stability)};
  const numerics::Place after{1.0, value_of(to.stability)};
  const double enough = at_two * std::min(std::abs(before.value), std::abs(after.value));
  const auto along = [&](double position) {
    const std::optional<continuation::CurvePoint> point = step.at(position);
    if (!point) return std::nan("");
    try {
      const double value = value_of(spectrum::floquet(*system, point->loop, isotropy));
      return std::abs(value) <= enough ? 0.0 : value;
    } catch (const core::NumericalError&) {
      return std::nan("");
    }
  };
  const auto root = numerics::locate_root(along, before, after, narrowest, most_orbits);
  return root && root->value == 0.0 && is_one_curve(step);
}

/// Of the index next to 2 from it.
double distance_of(const spectrum::Stability& s) {
  double distance = std::numeric_limits<double>::infinity();
  for (const std::complex<double>& k : s.fundamental) distance = std::min(distance, std::abs(k - 2.0));
  return distance;
}

/// So many times the step that is asked: the function comes to zero faster than a line.
constexpr double looked_ahead = 1.5;

/// Whether an index should have passed 2 on a step of this length, as it has gone before.
bool is_to_pass_two(const systems::Structure& system, const KnownStability& from, double length) {
  const double value = evaluate(index_two(), system, from.stability).value;
  return value * (value + looked_ahead * length * from.slope) < 0.0;
}

/// By which neighbours of an elliptic orbit go around, in the sense of its twist.
double angle_of(const spectrum::Stability& s) {
  return std::copysign(std::acos(0.5 * s.fundamental[0].real()), s.twist);
}

bool are_counted(const spectrum::Stability& from, const spectrum::Stability& to) {
  return !std::isnan(to.turns - from.turns);
}

/// Of a turn, by which it may change over a step.
constexpr double most_rotation = 0.25;
/// The same where an orbit is not elliptic: from an index above 2 to one below -2 it is half a turn.
constexpr double most_with_hyperbolic = 0.5;
/// How far apart orbits may be between which the angle passes a whole turn, in parts of the step below which nothing is
/// asked: a curve without a gap has them one such part apart, and twice that where it is bent.
constexpr double most_apart = 3.0;
/// By which the place is sought, at most: halving a step of length 1 takes 24.
constexpr int most_places = 60;
/// Iterations of the false position method after which the interval is halved.
constexpr int before_halving = 3;
/// Where the place is sought beside an end of the interval, how near to it, in parts of the least width: so that the
/// other end comes near too.
constexpr double beside_root = 0.4;

std::optional<spectrum::Stability> known_stability(const systems::System& system, const loop::Loop& loop,
                                                   const loop::Isotropy& isotropy) {
  try {
    return spectrum::floquet(system, loop, isotropy);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

/// Whether the angle passes a whole turn between two elliptic orbits as it does along one family: beside that place, on
/// either side, there are orbits as near to one another as steps that are not asked. Across a gap there are none.
bool passes_one_without_gap(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                            const continuation::Options& options, const KnownStability& from, const KnownStability& to,
                            TurningSense sense) {
  struct Place {
    double position;
    loop::Loop loop;
    double weight;  // the sense there, or less of it: for the false position method
  };
  Place before{0.0, from.orbit.loop, sense.at(from.stability).value_or(1.0)};
  Place after{1.0, to.orbit.loop, sense.at(to.stability).value_or(-1.0)};
  continuation::FamilyCurve step(system, isotropy, options);
  step.add(before.position, before.loop);
  step.add(after.position, after.loop);
  const double least_width = options.smallest_jump / continuation::arclength_between(before.loop, after.loop);
  for (int n = 1; n <= most_places && after.position - before.position > least_width; ++n) {
    const double width = after.position - before.position;
    const double share = n % before_halving == 0 ? 0.5 : before.weight / (before.weight - after.weight);
    const double least = std::min(0.5, beside_root * least_width / width);
    const double position = before.position + std::clamp(share, least, 1.0 - least) * width;
    std::optional<continuation::CurvePoint> point = step.at(position);
    const std::optional<spectrum::Stability> here =
        point ? known_stability(*system, point->loop, isotropy) : std::nullopt;
    const std::optional<double> turning = here ? sense.at(*here) : std::nullopt;
    if (!turning) return false;
    const bool is_before = *turning > 0.0;
    (is_before ? before : after) = {position, std::move(point->loop), *turning};
    (is_before ? after : before).weight *= 0.5;
    if (is_before) sense.carry_to(*here);
  }
  return continuation::arclength_between(before.loop, after.loop) <= most_apart * options.smallest_jump;
}

/// Whether multipliers pass 1 on a step where none do along the family: it turns neither in the parameter, nor is there
/// a curve with an orbit of that multiplier. Without pairs nothing else tells.
bool passes_one_across_gap(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                           const continuation::Options& options, const KnownStability& from, const KnownStability& to) {
  Step step(system, isotropy, options, from, to);
  const std::optional<continuation::CurvePoint> start = step.at(0.0, true);
  const std::optional<continuation::CurvePoint> end = step.at(1.0, true);
  if (!start || !end || level_slope(*system, *start) * level_slope(*system, *end) < 0.0) return false;
  return !has_index_two_between(system, isotropy, options, from, to);
}

/// Of the amplitude: over shorter steps the sense of rotation changes by rounding, or where an index passes 2.
constexpr double rotating_steps = 1e-3;

/// A prediction that is far off may have met another family. And where a family turns aside before an index is 2,
/// another one begins on the other side, whose index is as it was.
bool is_doubtful(const systems::Structure& system, const continuation::Options& options, const KnownStability& from,
                 const KnownStability& to) {
  const double length = continuation::arclength_between(from.orbit.loop, to.orbit.loop);
  return length >= options.smallest_jump && (to.orbit.halvings > 0 || is_to_pass_two(system, from, length));
}

/// Of a step on which no index passes 2.
bool has_jumped_unseen(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                       const continuation::Options& options, const KnownStability& from, const KnownStability& to) {
  if (!is_doubtful(system->structure(), options, from, to)) return false;
  Step step(system, isotropy, options, from, to);
  return !is_one_curve(step);
}

}  // namespace

double slope_to_two(const systems::Structure& system, const spectrum::Stability& before,
                    const spectrum::Stability& after, double length) {
  return (evaluate(index_two(), system, after).value - evaluate(index_two(), system, before).value) / length;
}

bool passes_two_only_at_folds(const systems::Structure& system, const loop::Isotropy& isotropy) {
  return system.symplectic &&
         std::none_of(isotropy.begin(), isotropy.end(), [](const loop::SymmetryElement& e) { return e.reversing; });
}

bool passes_one_unseen(const spectrum::Stability& from, const spectrum::Stability& to) {
  return TurningSense::reversed_between(from, to).has_value();
}

bool rotates_too_far(const spectrum::Stability& from, const spectrum::Stability& to) {
  const bool are_elliptic = is_elliptic(from) && is_elliptic(to);
  if (are_counted(from, to))
    return std::abs(to.turns - from.turns) > (are_elliptic ? most_rotation : most_with_hyperbolic);
  if (!are_elliptic || std::isnan(from.twist * to.twist)) return false;
  const double turn = 2.0 * std::numbers::pi;
  const double change = std::remainder(angle_of(to) - angle_of(from), turn);
  return std::abs(change) > most_rotation * turn;
}

bool are_turns_asked(const spectrum::Stability& from, const spectrum::Stability& to, double length,
                     double smallest_jump) {
  double largest = 4.0;
  for (const spectrum::Stability* s : {&from, &to})
    if (!s->fundamental.empty()) largest = std::max(largest, std::abs(s->fundamental[0]));
  return 4.0 / largest * length >= smallest_jump;
}

// Halves what is long, uneven, or the steepest.
bool is_one_curve(continuation::FamilyCurve& step) {
  struct Piece {
    double from;
    double to;
    loop::Loop before;
    loop::Loop after;
    double steepness;  // length, in parts of what it has of the chord
  };
  const double chord = continuation::arclength_between(step.known().front().loop, step.known().back().loop);
  const auto piece = [&](double from, double to, const loop::Loop& before, const loop::Loop& after) {
    return Piece{from, to, before, after, continuation::arclength_between(before, after) / ((to - from) * chord)};
  };
  std::vector<Piece> pieces{piece(0.0, 1.0, step.known().front().loop, step.known().back().loop)};
  double steepest = 0.0;  // of those that are settled
  while (!pieces.empty()) {
    const auto next = std::max_element(pieces.begin(), pieces.end(),
                                       [](const Piece& a, const Piece& b) { return a.steepness < b.steepness; });
    const Piece whole = std::move(*next);
    pieces.erase(next);
    const double middle = 0.5 * (whole.from + whole.to);
    const std::optional<continuation::CurvePoint> point = step.at(middle);
    if (!point) return false;
    const Piece halves[] = {piece(whole.from, middle, whole.before, point->loop),
                            piece(middle, whole.to, point->loop, whole.after)};
    const bool is_uneven = std::abs(halves[0].steepness - halves[1].steepness) > uneven * whole.steepness;
    for (const Piece& half : halves) {
      if (half.steepness > torn) return false;
      const double width = half.to - half.from;
      if (width >= longest_piece || (width > shortest_piece && (is_uneven || half.steepness > steepest)))
        pieces.push_back(half);
      else
        steepest = std::max(steepest, half.steepness);
    }
  }
  return true;
}

bool has_jumped(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                const continuation::Options& options, const KnownStability& from, const KnownStability& to) {
  const double length = continuation::arclength_between(from.orbit.loop, to.orbit.loop);
  const int before = evaluate(index_two(), system->structure(), from.stability).sign();
  const int after = evaluate(index_two(), system->structure(), to.stability).sign();
  if (!system->structure().symplectic)
    return before * after < 0 ? passes_one_across_gap(system, isotropy, options, from, to)
                              : has_jumped_unseen(system, isotropy, options, from, to);
  const bool has_turned = are_turns_asked(from.stability, to.stability, length, options.smallest_jump) &&
                          rotates_too_far(from.stability, to.stability);
  if (has_turned && are_counted(from.stability, to.stability)) return true;
  if (const auto sense = TurningSense::reversed_between(from.stability, to.stability)) {
    const bool is_told = std::isnan(from.stability.twist) || are_counted(from.stability, to.stability);
    return !is_told || !passes_one_without_gap(system, isotropy, options, from, to, *sense);
  }
  if (TurningSense::is_untold(from.stability, to.stability) && length >= options.smallest_jump) return true;
  if (has_turned &&
      loop::mean_distance(from.orbit.loop, to.orbit.loop) > rotating_steps * loop::rms_amplitude(to.orbit.loop))
    return true;
  if (before * after == 0) return false;
  if (before == after) return has_jumped_unseen(system, isotropy, options, from, to);
  if (!passes_two_only_at_folds(system->structure(), isotropy))
    return !has_index_two_between(system, isotropy, options, from, to);
  Step step(system, isotropy, options, from, to);
  const std::optional<continuation::CurvePoint> start = step.at(0.0, true);
  const std::optional<continuation::CurvePoint> end = step.at(1.0, true);
  if (!start || !end) return true;
  for (const continuation::CurvePoint* point : {&*start, &*end})
    if (along_chord(*point, start->loop, end->loop) < options.least_cosine) return true;
  if (level_slope(*system, *start) * level_slope(*system, *end) > 0.0) return true;
  // On either side of a gap slopes may be as they are at a fold.
  return std::max(distance_of(from.stability), distance_of(to.stability)) < told_apart &&
         !has_index_two_between(system, isotropy, options, from, to);
}

}  // namespace orbweaver::bifurcation
