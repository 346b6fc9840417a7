#pragma once

#include <map>
#include <string>
#include <vector>

#include "family.hpp"

namespace orbweaver::survey {

/// Names all families; parents come before children, and base families have theirs. A name is the parent's prefix (of a
/// base family the scene's letters), B, D or T3, a number by arclength where the parent has several places of that
/// kind, and letters where several families are born at one place. Whoever would have a name that is taken adds its
/// key.
void name_families(std::vector<Family>& families, const Crossings& crossings,
                   const std::map<std::string, std::string>& letters);

/// What families are called wherever a text speaks of them, by key.
[[nodiscard]] std::map<std::string, std::string> names_by_key(const std::vector<Family>& families);

/// a, b, ..., z, aa, ab, ...: of the n-th (from 0) of several families at one place.
[[nodiscard]] std::string twin_letters(std::size_t n);

}  // namespace orbweaver::survey
