#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "archive/sample.hpp"
#include "orbweaver/report/compare/comparison.hpp"

namespace orbweaver::test {

using archive::Records;
using report::Comparison;
using report::DifferenceKind;

inline constexpr double limit = 2.0;  // of s along every family

/// A family as a curve: T = from + s; energy and action are parabolas in s.
struct Curve {
  std::string key;
  double period;
  double energy;
  double bend;
};

inline archive::OrbitRecord orbit_of(const Curve& curve, int step, double s) {
  archive::OrbitRecord orbit;
  orbit.family_key = curve.key;
  orbit.step = step;
  orbit.arclength = s;
  orbit.period = curve.period + s;
  orbit.energy = curve.energy + 0.3 * s + curve.bend * s * s;
  orbit.action = 1.0 + curve.energy + s + 0.1 * s * s;
  orbit.cutoff = 1;
  orbit.stability = {2.0 * std::cos(s)};
  orbit.state = {0.0, 0.0};
  orbit.modes = std::vector<double>(6, 0.0);
  orbit.winding = {0.0};
  return orbit;
}

inline void add_orbits(Records& records, const Curve& curve, double spacing) {
  int step = 0;
  for (double s = 0.0; s < limit - 1e-9; s += spacing) records.orbits.push_back(orbit_of(curve, step++, s));
  records.orbits.push_back(orbit_of(curve, step, limit));
}

inline archive::CrossingRecord crossing_of(const Curve& curve, archive::CrossingKind kind, int multiplicity, double s) {
  const archive::OrbitRecord at = orbit_of(curve, 0, s);
  archive::CrossingRecord crossing;
  crossing.family_key = curve.key;
  crossing.arclength = s;
  crossing.period = at.period;
  crossing.energy = at.energy;
  crossing.kind = kind;
  crossing.multiplicity = multiplicity;
  crossing.kernel_dimension = multiplicity;
  crossing.state = {0.0, 0.0};
  crossing.sector_j = multiplicity - 1;
  crossing.sector_q = multiplicity;
  return crossing;
}

inline archive::FamilyRecord family_of(const std::string& key, const std::string& name, const std::string& parent,
                                       int crossing, int multiplicity) {
  archive::FamilyRecord family;
  family.key = key;
  family.name = name;
  family.parent_key = parent;
  family.crossing = crossing;
  family.multiplicity = multiplicity;
  family.isotropy = parent.empty() ? "S@1/2 R@0" : "R@0";
  family.end_reason = "step limit (100 steps)";
  return family;
}

inline const Curve root{"0000", 6.0, -1.0, 0.1};
inline const Curve other_root{"0001", 5.5, 0.5, 0.1};
inline const Curve first_twin{"0000/000/0", 13.1, -0.8, 0.05};
inline const Curve second_twin{"0000/000/1", 13.1, -0.8, 0.07};

/// Two families at equilibria; on the first a period doubling where twins are born and a branch point.
inline Records tree(double spacing = 0.1) {
  Records records;
  records.families = {family_of("0000", "Root", "", -1, 1), family_of("0001", "Other", "", -1, 1),
                      family_of("0000/000/0", "RDa", "0000", 0, 2), family_of("0000/000/1", "RDb", "0000", 0, 2)};
  records.crossings = {crossing_of(root, archive::CrossingKind::period_doubling, 2, 0.55),
                       crossing_of(root, archive::CrossingKind::branch_point, 1, 1.25),
                       crossing_of(other_root, archive::CrossingKind::period_doubling, 2, 0.35)};
  for (const Curve& curve : {root, other_root, first_twin, second_twin}) add_orbits(records, curve, spacing);
  return records;
}

inline archive::Archive written(const std::string& name, const Records& records,
                                const archive::Header& header = test::sample_header()) {
  return archive::Archive(test::write_sample_atlas(test::fresh_folder(name), header, records));
}

inline Comparison compared(const Records& a, const Records& b, const report::CompareOptions& options = {}) {
  return report::compare(written("a", a), written("b", b), options);
}

inline std::vector<DifferenceKind> kinds(const Comparison& comparison) {
  std::vector<DifferenceKind> out;
  for (const report::Difference& difference : comparison.differences) out.push_back(difference.kind);
  return out;
}

inline Records changed(const std::function<void(Records&)>& change) {
  Records records = tree();
  change(records);
  return records;
}

}  // namespace orbweaver::test
