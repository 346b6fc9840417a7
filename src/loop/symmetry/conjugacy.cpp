#include "orbweaver/loop/symmetry/conjugacy.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace orbweaver::loop {

namespace {

constexpr double same_matrix = 1e-9;  // as generated_group tells elements apart

Isotropy symmetries_of(const systems::Description& system) {
  Isotropy generators;
  for (const systems::Symmetry& s : system.equivariances) generators.push_back({s.name, false, s.matrix, 0, 1});
  for (const systems::Symmetry& r : system.reversors) generators.push_back({r.name, true, r.matrix, 0, 1});
  return generated_group(system, generators);
}

void set_shift(SymmetryElement& element, int numerator, int denominator) {
  const int p = ((numerator % denominator) + denominator) % denominator;
  const int common = std::gcd(p, denominator);
  element.shift_numerator = p / common;
  element.shift_denominator = denominator / common;
}

// w(t) = g z(t), or g z(-t): z(t + p) = M z(t) and z(p - t) = M z(t) become the same for w with g M g^-1, at -p if g
// reverses.
SymmetryElement conjugated(const SymmetryElement& g, SymmetryElement element) {
  element.matrix = (g.matrix * element.matrix * g.matrix.inverse()).eval();
  if (g.reversing) set_shift(element, -element.shift_numerator, element.shift_denominator);
  return element;
}

bool is_same(const SymmetryElement& a, const SymmetryElement& b) {
  return a.reversing == b.reversing && a.shift_numerator == b.shift_numerator &&
         a.shift_denominator == b.shift_denominator && a.matrix.isApprox(b.matrix, same_matrix);
}

bool is_same_group(const Isotropy& a, const Isotropy& b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const SymmetryElement& e) {
           return std::any_of(b.begin(), b.end(), [&](const SymmetryElement& other) { return is_same(e, other); });
         });
}

// A loop started later has the same equivariances, and reversors at phases that all moved by the same.
bool is_same_at_another_phase(const Isotropy& a, const Isotropy& b) {
  const auto reversor = std::find_if(a.begin(), a.end(), [](const SymmetryElement& e) { return e.reversing; });
  if (reversor == a.end()) return is_same_group(a, b);
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
    return is_same_group(shifted, b);
  });
}

}  // namespace

bool are_conjugate(const systems::Description& system, const Isotropy& a, const Isotropy& b) {
  const Isotropy group_a = generated_group(system, a);
  const Isotropy group_b = generated_group(system, b);
  if (group_a.size() != group_b.size()) return false;
  const Isotropy symmetries = symmetries_of(system);
  return std::any_of(symmetries.begin(), symmetries.end(), [&](const SymmetryElement& g) {
    Isotropy moved;
    for (const SymmetryElement& e : group_a) moved.push_back(conjugated(g, e));
    return is_same_at_another_phase(moved, group_b);
  });
}

}  // namespace orbweaver::loop
