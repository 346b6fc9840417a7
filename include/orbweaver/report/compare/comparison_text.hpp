#pragma once

#include <ostream>

#include "orbweaver/report/compare/comparison.hpp"

namespace orbweaver::report {

/// What differs, a paragraph a family, then the largest deviations and the verdict, in lines for people.
void print_comparison(std::ostream& out, const Comparison& comparison);

/// One object: same, a, b, matched, differences (kind, family_a, family_b, text, by, allowed), renamed, notes, largest.
void print_comparison_json(std::ostream& out, const Comparison& comparison);

}  // namespace orbweaver::report
