#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// A family that passes through a crossing of another one is born there, ends there, or has a crossing there itself.
class SharedPoints final : public Check {
 public:
  [[nodiscard]] std::vector<LoopQuestion> questions(const Evidence& evidence, std::span<const Answered> last) override {
    std::vector<LoopQuestion> asked;
    if (!last.empty()) return asked;
    const std::map<int, std::vector<int>> known = places_known(evidence);
    for (std::size_t row = 0; row < evidence.tree.crossings.size(); ++row) {
      const TreeCrossing& crossing = evidence.tree.crossings[row];
      if (!archive::has_sector(archive::crossing_kind_of(crossing.kind))) continue;
      const Invariants x = born_at(evidence, crossing);
      const double in_period = x.floor_of(Invariant::period);
      const double in_level = x.floor_of(Invariant::level);
      std::map<int, std::pair<double, std::size_t>> nearest;  // segment of each family
      for (const auto& [family, segment] :
           evidence.index.near(x.value(Invariant::period), x.value(Invariant::level), in_period, in_level)) {
        if (family == crossing.family && crossing.multiplicity == 1) continue;
        const double away = distance_from(evidence.family(family).curve.points(), segment, x);
        if (!may_have_index_two(evidence, evidence.family(family).curve.points(), segment)) continue;
        const auto [known_one, is_new] = nearest.try_emplace(family, away, segment);
        if (!is_new && away < known_one->second.first) known_one->second = {away, segment};
      }
      for (const auto& [family, place] : nearest) {
        const auto& [away, segment] = place;
        if (!std::isfinite(away) || is_known(evidence, known, family, x)) continue;
        if (segment == 0 && is_by_birth(evidence, family, crossing, x)) continue;
        if (!evidence.means.may_meet(crossing.family, family)) continue;
        asked.push_back({crossing.family, 0, static_cast<int>(row), family, static_cast<int>(segment)});
      }
    }
    return asked;
  }

  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> answered) const override {
    std::vector<Finding> found;
    for (const auto& [question, reply] : answered) {
      if (!reply.same && reply.decided) continue;
      const TreeCrossing& crossing = evidence.crossing(question.crossing);
      Finding finding;
      finding.kind = FindingKind::shared_point;
      finding.severity = reply.same ? Severity::contradiction : Severity::undecided;
      finding.family = question.beside;
      finding.other_family = question.family;
      finding.crossing = question.crossing;
      finding.period = crossing.multiplicity * crossing.period;
      finding.level = crossing.level;
      finding.deviation = reply.distance;
      found.push_back(finding);
    }
    return found;
  }

 private:
  /// Relative: what locations, and actions taken along dW/dE = T from the next stored orbit, may be off. A first look;
  /// loops decide.
  static constexpr double of_place = 1e-7;
  static constexpr double of_action = 1e-3;

  // Sum of the distances from the segment's two orbits, in period, level and action; infinite if the nearer one is
  // further away than a step: a family may turn between the two. Loops decide.
  static double distance_from(const std::vector<Invariants>& points, std::size_t segment, const Invariants& x) {
    const auto step = [&](std::size_t n) { return std::sqrt(square_distance(points[n], points[n + 1], x)); };
    double longest = step(segment);
    if (segment > 0) longest = std::fmax(longest, step(segment - 1));
    if (segment + 2 < points.size()) longest = std::fmax(longest, step(segment + 1));
    const double from = std::sqrt(square_distance(points[segment], x, x));
    const double to = std::sqrt(square_distance(points[segment + 1], x, x));
    return std::fmin(from, to) <= longest + of_action ? from + to : std::numeric_limits<double>::infinity();
  }

  // The index of an orbit that two families have in common is 2: a curve of orbits of its period leaves it in two
  // directions. Half a step beyond the segment, as for the other invariants. With several pairs the sum does not tell.
  static bool may_have_index_two(const Evidence& evidence, const std::vector<Invariants>& points, std::size_t segment) {
    if (!evidence.system->structure().symplectic || evidence.system->structure().pairs() != 1) return true;
    const auto [from, to] = range_beyond(points, segment, Invariant::trace);
    const double two = std::asinh(1.0);
    return !(two < from || two > to);
  }

  static double square_distance(const Invariants& a, const Invariants& b, const Invariants& x) {
    double sum = 0.0;
    for (const Invariant i : {Invariant::period, Invariant::level, Invariant::action}) {
      const double part = (a.value(i) - b.value(i)) / x.scale_of(i);
      if (!std::isnan(part)) sum += part * part;
    }
    return sum;
  }

  static bool is_near(const Invariants& x, double period, double level, double in_period = 0.0, double in_level = 0.0) {
    const double most_in_period = near_place * x.value(Invariant::period) + x.floor_of(Invariant::period) + in_period;
    const double most_in_level = near_place * x.scale_of(Invariant::level) + x.floor_of(Invariant::level) + in_level;
    return std::abs(period - x.value(Invariant::period)) <= most_in_period &&
           !(std::abs(level - x.value(Invariant::level)) > most_in_level);
  }
  /// Crossings that lie closer, relative in period and level and beyond their errors, are one place.
  static constexpr double near_place = 1e-5;

  // The orbit at the crossing, gone around as what is born there.
  static Invariants born_at(const Evidence& evidence, const TreeCrossing& crossing) {
    const TreeFamily& family = evidence.family(crossing.family);
    const double m = crossing.multiplicity;
    double action = archive::not_computed;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Invariants& point : family.curve.points()) {
      const double away = std::abs(point.value(Invariant::period) / crossing.period - 1.0) +
                          std::abs(point.value(Invariant::level) - crossing.level) / crossing.level_scale;
      if (!(away < nearest)) continue;
      nearest = away;
      if (evidence.tree.in_parameter()) continue;
      action = point.value(Invariant::action) + 0.5 * (point.value(Invariant::period) + crossing.period) *
                                                    (crossing.level - point.value(Invariant::level));
    }
    Invariants x;
    x.values = {m * crossing.period, crossing.level, m * action, archive::not_computed, archive::not_computed};
    x.scale = {m * crossing.period, crossing.level_scale, std::abs(m * action), 1.0, 1.0};
    for (std::size_t i = 0; i < x.floor.size(); ++i) x.floor[i] = of_place * x.scale[i];
    x.floor[static_cast<std::size_t>(Invariant::period)] += m * crossing.place_error_period;
    x.floor[static_cast<std::size_t>(Invariant::level)] += crossing.place_error_level;
    x.floor[static_cast<std::size_t>(Invariant::action)] = of_action * x.scale_of(Invariant::action);
    return x;
  }

  // Beyond the place where the family is born, seen from its first orbit: nothing of it is there, and what loops are
  // corrected to is the family that it was born on. That one's other crossings do not lie on the way from the birth to
  // the first orbit either: on it no orbit repeats as the base does (continuation/way_from_start.hpp).
  static bool is_by_birth(const Evidence& evidence, int family, const TreeCrossing& crossing, const Invariants& x) {
    const int row = evidence.tree.families[static_cast<std::size_t>(family)].crossing;
    const std::vector<Invariants>& points = evidence.family(family).curve.points();
    if (row < 0 || points.empty()) return false;
    if (evidence.family(family).birth_arclength > evidence.family(family).arclengths.front()) return false;
    const TreeCrossing& birth = evidence.crossing(row);
    double along = 0.0;
    double way = 0.0;
    for (const auto& [i, at_birth] :
         {std::pair{Invariant::period, birth.multiplicity * birth.period}, std::pair{Invariant::level, birth.level}}) {
      const double first = (points.front().value(i) - at_birth) / x.scale_of(i);
      const double part = (x.value(i) - at_birth) / x.scale_of(i) * first;
      if (std::isnan(part)) continue;
      along += part;
      way += first * first;
    }
    const bool is_on_base = crossing.family == birth.family && crossing.multiplicity == birth.multiplicity;
    return along < (is_on_base ? way : 0.0);
  }

  // Crossings where a family is born, ends, or that lie on it.
  static std::map<int, std::vector<int>> places_known(const Evidence& evidence) {
    std::map<int, std::vector<int>> known;
    for (std::size_t row = 0; row < evidence.tree.families.size(); ++row) {
      std::vector<int>& places = known[static_cast<int>(row)];
      places = evidence.tree.families[row].crossings;
      if (evidence.tree.families[row].crossing >= 0) places.push_back(evidence.tree.families[row].crossing);
    }
    for (const EndEvidence& end : evidence.known.tree.ends)
      if (end.crossing >= 0) known[evidence.row_of(end.family)].push_back(end.crossing);
    return known;
  }

  static bool is_known(const Evidence& evidence, const std::map<int, std::vector<int>>& known, int family,
                       const Invariants& x) {
    // A family that ends there says so, whether or not it was brought together with the crossing: the check of ends
    // judges.
    for (const EndEvidence& end : evidence.known.tree.ends)
      if (end.met && evidence.row_of(end.family) == family && is_near(x, end.period, end.level)) return true;
    const std::vector<int>& places = known.at(family);
    return std::any_of(places.begin(), places.end(), [&](int row) {
      const TreeCrossing& place = evidence.crossing(row);
      const double around = place.family == family ? 1.0 : place.multiplicity;
      return is_near(x, around * place.period, place.level, around * place.place_error_period, place.place_error_level);
    });
  }
};

}  // namespace orbweaver::survey
