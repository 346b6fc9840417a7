#include "orbweaver/loop/symmetry/conjugacy.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::loop {

namespace {

void set_shift(SymmetryElement& element, int numerator, int denominator) {
  const int p = ((numerator % denominator) + denominator) % denominator;
  const int common = std::gcd(p, denominator);
  element.shift_numerator = p / common;
  element.shift_denominator = denominator / common;
}

// w(t) = g z(t), or g z(-t): z(t + p) = M z(t) and z(p - t) = M z(t) become the same for w with g M g^-1, at -p if g
// reverses.
SymmetryElement conjugated(const SymmetryElement& g, SymmetryElement element) {
  element.map = g.map * element.map * g.map.inverse();
  if (g.reversing) set_shift(element, -element.shift_numerator, element.shift_denominator);
  return element;
}

bool is_same(const SymmetryElement& a, const SymmetryElement& b, const std::vector<int>& angles) {
  return a.reversing == b.reversing && a.shift_numerator == b.shift_numerator &&
         a.shift_denominator == b.shift_denominator && a.map.is_same(b.map, angles);
}

bool is_same_group(const Isotropy& a, const Isotropy& b, const std::vector<int>& angles) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const SymmetryElement& e) {
           return std::any_of(b.begin(), b.end(),
                              [&](const SymmetryElement& other) { return is_same(e, other, angles); });
         });
}

// A loop started later has the same equivariances, and reversors at phases that all moved by the same.
bool is_same_at_another_phase(const Isotropy& a, const Isotropy& b, const std::vector<int>& angles) {
  const auto reversor = std::find_if(a.begin(), a.end(), [](const SymmetryElement& e) { return e.reversing; });
  if (reversor == a.end()) return is_same_group(a, b, angles);
  return std::any_of(b.begin(), b.end(), [&](const SymmetryElement& other) {
    if (!other.reversing) return false;
    const int q = std::lcm(reversor->shift_denominator, other.shift_denominator);
    const int moved = other.shift_numerator * (q / other.shift_denominator) -
                      reversor->shift_numerator * (q / reversor->shift_denominator);
    Isotropy shifted = a;
    for (SymmetryElement& e : shifted) {
      if (!e.reversing) continue;
      const int common = std::lcm(e.shift_denominator, q);
      set_shift(e, e.shift_numerator * (common / e.shift_denominator) + moved * (common / q), common);
    }
    return is_same_group(shifted, b, angles);
  });
}

}  // namespace

bool are_conjugate(const systems::Structure& system, const Isotropy& a, const Isotropy& b) {
  const Isotropy group_a = SymmetryGroup(system, a).elements();
  const Isotropy group_b = SymmetryGroup(system, b).elements();
  if (group_a.size() != group_b.size()) return false;
  const SymmetryGroup space = SymmetryGroup::of_space(system);
  return std::any_of(space.elements().begin(), space.elements().end(), [&](const SymmetryElement& g) {
    Isotropy moved;
    for (const SymmetryElement& e : group_a) moved.push_back(conjugated(g, e));
    return is_same_at_another_phase(moved, group_b, system.angles);
  });
}

}  // namespace orbweaver::loop
