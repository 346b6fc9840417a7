#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "witness/check.hpp"
#include "witness/stored_stability.hpp"

namespace orbweaver::survey {

/// No orbit is stored in two families, nor, with its images under the system's symmetries, twice in one. Families that
/// begin at images of one another (equilibria, Hopf points) are images too, and are stored both; what descends from
/// them as well.
class StoredTwice final : public Check {
 public:
  /// Of each family the next one before it, or itself, with which it may have a curve in common. Families that are the
  /// same stand for one another: of those that one was found to be, no other is asked about.
  [[nodiscard]] std::vector<LoopQuestion> questions(const Evidence& evidence, std::span<const Answered> last) override {
    for_each_pair(last, [&](const Pair& pair, std::span<const Answered> of_pair) {
      const int first = stands_for(pair.first);
      const int second = stands_for(pair.second);
      if (first != second && std::all_of(of_pair.begin(), of_pair.end(), [](const auto& a) { return a.reply.same; }))
        _turns[static_cast<std::size_t>(second)].same = first;
    });
    _turns.resize(evidence.tree.families.size());
    std::vector<LoopQuestion> asked;
    for (int row = 0; row < static_cast<int>(_turns.size()); ++row) {
      Turn& turn = _turns[static_cast<std::size_t>(row)];
      while (turn.next <= row) {
        const int other = turn.next++;
        if (!may_be_same(evidence, row, other)) continue;
        const std::vector<LoopQuestion> hits = hits_of(evidence, other, row);
        if (hits.size() < least_hits) continue;
        const std::size_t count = std::min(compared, hits.size());
        for (std::size_t c = 0; c < count; ++c) asked.push_back(hits[(2 * c + 1) * hits.size() / (2 * count)]);
        turn.asked.push_back(other);
        break;
      }
    }
    return asked;
  }

  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> answered) const override {
    std::vector<Answered> by_pair(answered.begin(), answered.end());
    std::stable_sort(by_pair.begin(), by_pair.end(),
                     [](const Answered& a, const Answered& b) { return pair_of(a.question) < pair_of(b.question); });
    std::vector<Finding> found;
    for_each_pair(by_pair,
                  [&](const Pair& pair, std::span<const Answered> of_pair) { judge(evidence, pair, of_pair, found); });
    return found;
  }

 private:
  using Pair = std::pair<int, int>;
  /// One common orbit is a crossing of two curves; more are a common curve.
  static constexpr std::size_t least_hits = 2;
  /// Loops that are compared for a pair of families.
  static constexpr std::size_t compared = 5;
  /// Of the floors of period and level: as two computations of one orbit differ.
  static constexpr double floors = 3.0;
  /// How near, relative in period and level, a crossing is to an orbit that two families share there.
  static constexpr double near_crossing = 1e-4;
  /// Segments beside an orbit that are its own.
  static constexpr std::size_t own_segments = 2;

  static Pair pair_of(const LoopQuestion& question) { return std::minmax(question.family, question.beside); }

  /// How far a family has come in the list of those before it.
  struct Turn {
    int next = 0;
    int same = -1;           ///< an earlier family that is the same curve; -1: none is known
    std::vector<int> asked;  ///< earlier families that it was held against
  };
  std::vector<Turn> _turns;  // by row

  /// The first of the families that are known to be the same as this one.
  [[nodiscard]] int stands_for(int row) const {
    while (_turns[static_cast<std::size_t>(row)].same >= 0) row = _turns[static_cast<std::size_t>(row)].same;
    return row;
  }

  [[nodiscard]] bool may_be_same(const Evidence& evidence, int row, int other) const {
    if (row == other) return true;
    const int first = stands_for(other);
    if (first == stands_for(row)) return false;
    const std::vector<int>& asked = _turns[static_cast<std::size_t>(row)].asked;
    return std::none_of(asked.begin(), asked.end(), [&](int one) { return stands_for(one) == first; }) &&
           evidence.index.may_meet(other, row, floors) && evidence.means.may_meet(other, row) &&
           !are_images(evidence, other, row);
  }

  template <class Visitor>
  static void for_each_pair(std::span<const Answered> answered, const Visitor& visit) {
    for (std::size_t begin = 0, end = 0; begin < answered.size(); begin = end) {
      const Pair pair = pair_of(answered[begin].question);
      while (end < answered.size() && pair_of(answered[end].question) == pair) ++end;
      visit(pair, answered.subspan(begin, end - begin));
    }
  }

  /// The orbits of one of two families whose invariants lie on the other's curve.
  static std::vector<LoopQuestion> hits_of(const Evidence& evidence, int first, int second) {
    std::vector<LoopQuestion> hits;
    add_hits(evidence, first, second, hits);
    if (first != second) add_hits(evidence, second, first, hits);
    return hits;
  }

  static void add_hits(const Evidence& evidence, int own, int other, std::vector<LoopQuestion>& hits) {
    const std::vector<Invariants>& points = evidence.family(own).curve.points();
    for (std::size_t n = 0; n < points.size(); ++n) {
      const Invariants& x = points[n];
      const auto near =
          evidence.index.near_on(other, x.value(Invariant::period), x.value(Invariant::level),
                                 floors * x.floor_of(Invariant::period), floors * x.floor_of(Invariant::level));
      const auto hit = std::find_if(near.begin(), near.end(), [&](const CurveIndex::Segment& at) {
        return !(other == own && is_own(evidence.family(own), n, at.segment)) &&
               evidence.family(other).curve.fit_near(x, at.segment, 0).fits();
      });
      if (hit != near.end()) hits.push_back({own, static_cast<int>(n), -1, other, static_cast<int>(hit->segment)});
    }
  }

  static bool is_own(const TreeFamily& family, std::size_t orbit, std::size_t segment) {
    const std::size_t apart = orbit > segment ? orbit - segment : segment - orbit;
    if (apart <= own_segments) return true;
    const bool closes = std::any_of(family.ends.begin(), family.ends.end(),
                                    [](const FamilyEnd& end) { return end.kind == EndKind::closed_loop; });
    if (!closes) return false;
    // The last orbit may lie beyond the first, by less than the last step: there the first steps are short.
    const std::vector<double>& s = family.arclengths;
    const double around = s[std::min(orbit, segment)] - s.front() + s.back() - s[std::max(orbit, segment + 1)];
    return apart + own_segments >= family.orbits() || around <= s.back() - s[s.size() - 2];
  }

  // Whether they descend from families that begin at images of one another, and are not their own images.
  static bool are_images(const Evidence& evidence, int row, int other) {
    if (!evidence.begin_at_images(row, other)) return false;
    const systems::Structure& structure = evidence.system->structure();
    const loop::SymmetryGroup group(structure, loop::isotropy_of(structure, evidence.family(row).isotropy));
    return std::none_of(group.elements().begin(), group.elements().end(), [&](const loop::SymmetryElement& element) {
      return evidence.begins_at_image(element.map, row, other);
    });
  }

  // Two ends of one curve that have run past one another: with more steps, or where rounding leaves it, one comes to
  // where the other begins.
  static bool both_end_by(const Evidence& evidence, const Pair& pair, EndKind kind) {
    const auto ends_by = [&](int row) {
      const std::vector<FamilyEnd>& ends = evidence.family(row).ends;
      return std::any_of(ends.begin(), ends.end(), [&](const FamilyEnd& end) { return end.kind == kind; });
    };
    return pair.first != pair.second && ends_by(pair.first) && ends_by(pair.second);
  }

  static Severity severity_of(const Evidence& evidence, const Pair& pair, bool is_told) {
    if (both_end_by(evidence, pair, EndKind::step_limit)) return Severity::cut;
    return is_told && !both_end_by(evidence, pair, EndKind::undecided) ? Severity::contradiction : Severity::undecided;
  }

  // Whether a crossing that one of the two lies on, is born at or ends at is this orbit.
  static bool has_crossing_at(const Evidence& evidence, const Pair& pair, const Invariants& x) {
    const auto is_here = [&](int row) {
      if (row < 0) return false;
      const TreeCrossing& crossing = evidence.crossing(row);
      const double period = x.value(Invariant::period);
      const double around = std::max(1.0, std::round(period / crossing.period));
      return std::abs(around * crossing.period - period) <=
                 near_crossing * period + around * crossing.place_error_period &&
             !(std::abs(crossing.level - x.value(Invariant::level)) >
               near_crossing * x.scale_of(Invariant::level) + crossing.place_error_level);
    };
    for (const int row : {pair.first, pair.second}) {
      const TreeFamily& family = evidence.family(row);
      if (is_here(family.crossing) || is_here(family.end_crossing)) return true;
      if (std::any_of(family.crossings.begin(), family.crossings.end(), is_here)) return true;
    }
    return false;
  }

  /// Whether the multipliers of an orbit are on another side of 1 than those of the orbits that it lies between, as far
  /// as rounding tells those: along a family they pass 1 at a crossing or a fold, and not without a word.
  static bool is_told_apart(const Evidence& evidence, const LoopQuestion& question) {
    const TreeFamily& family = evidence.family(question.family);
    const TreeFamily& beside = evidence.family(question.beside);
    if (family.isotropy != beside.isotropy) return false;
    const auto segment = static_cast<std::size_t>(question.segment);
    const int side = stored_side_of_one(evidence, family, static_cast<std::size_t>(question.orbit));
    const int before = side * stored_side_of_one(evidence, beside, segment);
    const int behind = side * stored_side_of_one(evidence, beside, segment + 1);
    return before <= 0 && behind <= 0 && before + behind < 0;
  }

  /// Whether the orbit and those two that it lies between are beside the crossing of its family at which theirs is
  /// born, no further from it than the two are from one another. Period and level are nearly the same on both families
  /// there, and between images of one another, across the crossing, no orbit may converge.
  static bool is_beside_birth(const Evidence& evidence, const LoopQuestion& question) {
    const TreeFamily& born = evidence.family(question.beside);
    if (born.crossing < 0 || evidence.crossing(born.crossing).family != question.family) return false;
    const auto segment = static_cast<std::size_t>(question.segment);
    const double before = born.arclengths[segment];
    const double behind = born.arclengths[segment + 1];
    const double own = evidence.family(question.family).arclengths[static_cast<std::size_t>(question.orbit)];
    const double place = evidence.tree.atlas.crossings().reals("arclength")[static_cast<std::size_t>(born.crossing)];
    const double away = std::max({before - born.birth_arclength, born.birth_arclength - behind, std::abs(own - place)});
    return away <= behind - before;
  }

  /// The steepest index that has passed 2 by less than rounding tells on the way to what the question compares: between
  /// the two runs of one curve, or since either family's first step. 0: none has.
  static double untold_on_the_way(const Evidence& evidence, const LoopQuestion& question) {
    const auto orbit = static_cast<std::size_t>(question.orbit);
    const auto segment = static_cast<std::size_t>(question.segment);
    const auto between = [&](const TreeFamily& family, std::size_t a, std::size_t b) {
      return untold_between(evidence, family, std::min(a, b), std::max(a, b));
    };
    const TreeFamily& family = evidence.family(question.family);
    if (question.family == question.beside) return between(family, orbit, segment);
    const TreeFamily& beside = evidence.family(question.beside);
    return std::max(between(family, evidence.tree.first_step_of(family), orbit),
                    between(beside, evidence.tree.first_step_of(beside), segment));
  }

  static void judge(const Evidence& evidence, const Pair& pair, std::span<const Answered> answered,
                    std::vector<Finding>& found) {
    const auto is_same = [](const Answered& a) { return a.reply.same; };
    const auto same = std::count_if(answered.begin(), answered.end(), is_same);
    const bool any_decided = std::any_of(answered.begin(), answered.end(), [&](const Answered& a) {
      return a.reply.decided || is_told_apart(evidence, a.question);
    });
    const bool all_beside_birth = std::all_of(answered.begin(), answered.end(),
                                              [&](const Answered& a) { return is_beside_birth(evidence, a.question); });
    if (same == 0 && (any_decided || all_beside_birth)) return;
    const auto first = std::find_if(answered.begin(), answered.end(), is_same);
    const Answered& shown = first == answered.end() ? answered.front() : *first;
    const Invariants& x =
        evidence.family(shown.question.family).curve.points()[static_cast<std::size_t>(shown.question.orbit)];
    Finding finding;
    finding.kind = pair.first == pair.second ? FindingKind::retraced_curve : FindingKind::duplicate_curve;
    const bool is_told = same >= static_cast<std::ptrdiff_t>(least_hits) ||
                         (same == 1 && pair.first != pair.second && !has_crossing_at(evidence, pair, x));
    finding.severity = severity_of(evidence, pair, is_told);
    if (const double untold = untold_on_the_way(evidence, shown.question);
        untold > 0.0 && finding.severity == Severity::contradiction) {
      finding.severity = Severity::undecided;
      finding.detail = fmt::format("an index of {:.1e} passes 2 on the way: families cross there to rounding", untold);
    }
    finding.family = pair.first;
    finding.other_family = pair.first == pair.second ? -1 : pair.second;
    finding.period = x.value(Invariant::period);
    finding.level = x.value(Invariant::level);
    finding.deviation = shown.reply.distance;
    finding.number = static_cast<int>(same);
    finding.other_number = static_cast<int>(answered.size());
    found.push_back(finding);
  }
};

}  // namespace orbweaver::survey
