#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tasks/payload/keys.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Families that begin where a symmetry maps one beginning to the other (equilibria, Hopf points) are images: they have
/// the same crossings, ends and extents, and so has what is born there.
class MirrorImages final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    std::map<std::string, std::vector<int>> base;  // rows by the mode of the equilibrium; of all Hopf points together
    for (std::size_t row = 0; row < evidence.tree.families.size(); ++row) {
      if (evidence.tree.families[row].parent >= 0) continue;
      const std::string& key = evidence.key(static_cast<int>(row));
      base[evidence.known.beginnings.contains(base_of(key)) ? "" : mode_of(key)].push_back(static_cast<int>(row));
    }
    for (const auto& [mode, rows] : base)
      for (const int row : rows)
        if (const int image = image_of(evidence, row, rows); image >= 0) compare(evidence, row, image, found);
    return found;
  }

 private:
  /// Relative in period and level, beyond the errors of both places: what two computations of one curve differ by.
  static constexpr double same_place = 1e-6;

  // The last of the later ones that begins at an image and shares its first orbits' period most nearly: modes with
  // two sides have two rows.
  static int image_of(const Evidence& evidence, int row, const std::vector<int>& rows) {
    int best = -1;
    for (const int other : rows) {
      if (other <= row || !evidence.begin_at_images(row, other)) continue;
      if (evidence.family(row).orbits() == 0 || evidence.family(other).orbits() == 0) continue;
      if (best < 0 || extent_apart(evidence, row, other) < extent_apart(evidence, row, best)) best = other;
    }
    return best;
  }

  static double extent_apart(const Evidence& evidence, int row, int other) {
    const Invariants& a = evidence.family(row).curve.points().back();
    const Invariants& b = evidence.family(other).curve.points().back();
    return std::abs(a.value(Invariant::period) / b.value(Invariant::period) - 1.0);
  }

  static void compare(const Evidence& evidence, int row, int image, std::vector<Finding>& found) {
    const TreeFamily& a = evidence.family(row);
    const TreeFamily& b = evidence.family(image);
    Finding finding;
    finding.severity = std::max(evidence.severity_about(row), evidence.severity_about(image));
    finding.family = row;
    finding.other_family = image;
    const bool backwards = runs_backwards(evidence, a, b);
    compare_ends(evidence, finding, backwards, found);
    if (a.crossings.size() != b.crossings.size()) {
      finding.kind = FindingKind::mirror_crossings;
      finding.number = static_cast<int>(a.crossings.size());
      finding.other_number = static_cast<int>(b.crossings.size());
      finding.deviation = std::abs(finding.number - finding.other_number);
      found.push_back(finding);
      return;
    }
    for (std::size_t n = 0; n < a.crossings.size(); ++n) {  // by arclength
      const TreeCrossing& x = evidence.crossing(a.crossings[n]);
      const TreeCrossing& y = evidence.crossing(b.crossings[place_of(n, b.crossings.size(), backwards)]);
      const double away = apart_beyond_errors(x, y);
      if (is_another(x, y)) {
        finding.kind = FindingKind::mirror_place;
        finding.crossing = a.crossings[n];
        finding.period = x.period;
        finding.level = x.level;
        finding.deviation = away;
        found.push_back(finding);
      } else if (x.children.size() == y.children.size()) {  // others: a branch between the images is stored once
        for (std::size_t c = 0; c < x.children.size(); ++c) compare(evidence, x.children[c], y.children[c], found);
      }
    }
  }

  static bool is_another(const TreeCrossing& x, const TreeCrossing& y) {
    return x.kind != y.kind || x.multiplicity != y.multiplicity || apart_beyond_errors(x, y) > same_place;
  }

  static std::size_t place_of(std::size_t n, std::size_t count, bool backwards) {
    return backwards ? count - 1 - n : n;
  }

  /// Which side of a crossing is the positive one is a matter of the kernel vector's sign: images that were followed to
  /// both sides may run against one another.
  static bool runs_backwards(const Evidence& evidence, const TreeFamily& a, const TreeFamily& b) {
    if (a.ends.size() < 2 || b.ends.size() < 2 || a.crossings.size() != b.crossings.size()) return false;
    const auto others = [&](bool backwards) {
      int count = 0;
      for (std::size_t n = 0; n < a.crossings.size(); ++n)
        if (is_another(evidence.crossing(a.crossings[n]),
                       evidence.crossing(b.crossings[place_of(n, b.crossings.size(), backwards)])))
          ++count;
      return count;
    };
    return others(true) < others(false);
  }

  static void compare_ends(const Evidence& evidence, Finding finding, bool backwards, std::vector<Finding>& found) {
    const TreeFamily& a = evidence.family(finding.family);
    const TreeFamily& b = evidence.family(finding.other_family);
    finding.kind = FindingKind::mirror_end;
    if (a.ends.size() != b.ends.size()) return found.push_back(finding);
    if (a.orbits() < 2 || b.orbits() < 2) return;
    for (std::size_t n = 0; n < a.ends.size(); ++n) {
      const std::size_t m = place_of(n, b.ends.size(), backwards);
      if (a.ends[n].kind == b.ends[m].kind && meet_at_images(evidence, finding, a.ends[n].orbit, b.ends[m].orbit))
        continue;
      const Invariants& x = a.curve.points()[a.ends[n].orbit];
      const Invariants& y = b.curve.points()[b.ends[m].orbit];
      const double apart = std::abs(x.value(Invariant::period) - y.value(Invariant::period));
      // Their steps need not be the same: one may stop a step before the other.
      if (a.ends[n].kind == b.ends[m].kind && apart <= last_step(a, n) + last_step(b, m)) continue;
      finding.period = x.value(Invariant::period);
      finding.level = x.value(Invariant::level);
      finding.deviation = apart / x.scale_of(Invariant::period);
      found.push_back(finding);
    }
  }

  // Where both have met another family their last orbits may stand anywhere before: the meeting points are compared.
  static bool meet_at_images(const Evidence& evidence, const Finding& finding, std::size_t orbit,
                             std::size_t other_orbit) {
    const EndEvidence* end = meeting_of(evidence, finding.family, orbit);
    const EndEvidence* other = meeting_of(evidence, finding.other_family, other_orbit);
    if (end == nullptr || other == nullptr) return false;
    const double scale = evidence.family(finding.family).curve.points()[orbit].scale_of(Invariant::level);
    return std::abs(end->period / other->period - 1.0) <= same_meeting &&
           !(std::abs(end->level - other->level) > same_meeting * scale);
  }
  /// Relative in period and level: what the extrapolation to a meeting may be off (tree/arrivals.cpp).
  static constexpr double same_meeting = 1e-3;

  // How the side of the family that ends with this orbit ended, if it met another family; null otherwise.
  static const EndEvidence* meeting_of(const Evidence& evidence, int row, std::size_t orbit) {
    const bool forwards = orbit + 1 == evidence.family(row).orbits();
    for (const EndEvidence& end : evidence.known.tree.ends)
      if (end.met && (end.side > 0) == forwards && end.family == evidence.key(row)) return &end;
    return nullptr;
  }

  // Change of the period over the last step before an end.
  static double last_step(const TreeFamily& family, std::size_t end) {
    const std::vector<Invariants>& points = family.curve.points();
    const std::size_t last = family.ends[end].orbit;
    const std::size_t before = last == 0 ? 1 : last - 1;
    return std::abs(points[last].value(Invariant::period) - points[before].value(Invariant::period));
  }
};

}  // namespace orbweaver::survey
