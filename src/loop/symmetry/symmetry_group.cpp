#include "orbweaver/loop/symmetry/symmetry_group.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

namespace {

using systems::AffineMap;

/// More than the symmetries of any orbit in view (96 those of a cube with time shifts and reversal): what generates
/// more was declared with rounding errors or by mistake.
constexpr std::size_t largest_group = 1000;

// z(t + a) = g z(t) and z(t + b) = h z(t) give z(t + b + a) = g h z(t); z(b - t) = h z(t) gives z(b - t + a) = g h
// z(t); g reversing: z(a - (t + b)) = g h z(t), so that b counts backwards.
SymmetryElement product(const SymmetryElement& g, const SymmetryElement& h) {
  SymmetryElement out{"", g.reversing != h.reversing, g.map * h.map, 0, 1};
  const int q = std::lcm(g.shift_denominator, h.shift_denominator);
  const int a = g.shift_numerator * (q / g.shift_denominator);
  const int b = h.shift_numerator * (q / h.shift_denominator);
  const int p = (((g.reversing ? a - b : a + b) % q) + q) % q;
  const int common = std::gcd(p, q);
  out.shift_numerator = p / common;
  out.shift_denominator = q / common;
  return out;
}

bool is_same(const SymmetryElement& a, const SymmetryElement& b, const std::vector<int>& angles) {
  return a.reversing == b.reversing && a.shift_numerator == b.shift_numerator &&
         a.shift_denominator == b.shift_denominator && a.map.is_same(b.map, angles);
}

/// That of the declared symmetry, or of the identity; else `otherwise`.
std::string name_of(const systems::Structure& structure, const SymmetryElement& element, const std::string& otherwise) {
  const auto identity = AffineMap::identity(structure.dimension);
  if (!element.reversing && element.map.is_same(identity, structure.angles)) return "1";
  for (const systems::Symmetry& s : element.reversing ? structure.reversors : structure.equivariances)
    if (element.map.is_same(s.map, structure.angles)) return s.name;
  return otherwise;
}

AffineMap power(const AffineMap& map, int exponent) {
  AffineMap result = AffineMap::identity(map.dimension());
  for (int n = 0; n < exponent; ++n) result = map * result;
  return result;
}

const SymmetryElement* first_reversor(const Isotropy& elements, bool at_start) {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const SymmetryElement& e) {
    return e.reversing && (!at_start || e.shift_numerator == 0);
  });
  return found == elements.end() ? nullptr : &*found;
}

}  // namespace

SymmetryGroup::SymmetryGroup(const systems::Structure& structure, const Isotropy& generators)
    : _elements{{"1", false, AffineMap::identity(structure.dimension), 0, 1}}, _angles(structure.angles) {
  Isotropy equivariances;
  std::copy_if(generators.begin(), generators.end(), std::back_inserter(equivariances),
               [](const SymmetryElement& e) { return !e.reversing; });
  close(structure, equivariances);
  if (equivariances.size() < generators.size()) close(structure, generators);
  set_generator();
}

SymmetryGroup SymmetryGroup::of_space(const systems::Structure& structure) {
  Isotropy declared;
  for (const systems::Symmetry& s : structure.equivariances) declared.push_back({s.name, false, s.map, 0, 1});
  for (const systems::Symmetry& r : structure.reversors) declared.push_back({r.name, true, r.map, 0, 1});
  return {structure, declared};
}

void SymmetryGroup::close(const systems::Structure& structure, const Isotropy& generators) {
  for (std::size_t n = 0; n < _elements.size(); ++n)
    for (const SymmetryElement& generator : generators) {
      SymmetryElement next = product(generator, _elements[n]);
      const auto is_next = [&](const SymmetryElement& known) { return is_same(known, next, _angles); };
      if (std::any_of(_elements.begin(), _elements.end(), is_next)) continue;
      core::require(_elements.size() < largest_group, "these symmetries generate more than 1000");
      next.name = name_of(structure, next, generator.name + _elements[n].name);
      _elements.push_back(std::move(next));
    }
}

void SymmetryGroup::set_generator() {
  _order = 1;
  _generator = _elements.front().map;
  for (const SymmetryElement& e : _elements)
    if (!e.reversing) _order = std::lcm(_order, e.shift_denominator);
  if (_order == 1) return;
  bool chosen = false;
  for (const SymmetryElement& e : _elements) {
    if (e.reversing || e.shift_numerator != 1 || e.shift_denominator != _order) continue;
    const bool closes = power(e.map, _order).is_same(_elements.front().map, _angles);
    if (!chosen || closes) _generator = e.map;
    chosen = true;
    if (closes) break;
  }
  core::require(chosen, "these symmetries are no group: none has the least time shift");
}

SymmetryGroup SymmetryGroup::subgroup(const std::function<bool(const SymmetryElement&)>& keeps) const {
  SymmetryGroup out;
  out._angles = _angles;
  out._elements.push_back(_elements.front());  // the identity, also where nothing can be said of the others
  std::copy_if(_elements.begin() + 1, _elements.end(), std::back_inserter(out._elements), keeps);
  out.set_generator();
  return out;
}

const SymmetryElement* SymmetryGroup::reversor() const { return first_reversor(_elements, false); }

const SymmetryElement* SymmetryGroup::reversor_at_start() const { return first_reversor(_elements, true); }

}  // namespace orbweaver::loop
