#include "orbweaver/loop/symmetry/isotropy_text.hpp"

#include <sstream>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

namespace {

SymmetryElement element_of(const systems::Structure& system, const std::string& word) {
  SymmetryElement element;
  const std::size_t mark = word.find('@');
  element.name = word.substr(0, mark);
  if (element.name == "1") element.map = systems::AffineMap::identity(system.dimension);
  for (const systems::Symmetry& s : system.equivariances)
    if (s.name == element.name) element.map = s.map;
  for (const systems::Symmetry& r : system.reversors)
    if (r.name == element.name) element.map = r.map, element.reversing = true;
  char slash = '/';
  std::istringstream shift(mark == std::string::npos ? "" : word.substr(mark + 1));
  shift >> element.shift_numerator;
  const bool is_whole = shift.eof();
  if (!is_whole) shift >> slash >> element.shift_denominator;
  if (element.map.dimension() == 0 || shift.fail() || !shift.eof() || slash != '/' || element.shift_denominator < 1)
    throw core::InputError(fmt::format("expected a symmetry of the system such as S@1/2 or R@0, got '{}'", word));
  return element;
}

}  // namespace

Isotropy isotropy_of(const systems::Structure& system, const std::string& text) {
  Isotropy isotropy;
  std::istringstream words(text);
  for (std::string word; words >> word;) isotropy.push_back(element_of(system, word));
  return isotropy;
}

}  // namespace orbweaver::loop
