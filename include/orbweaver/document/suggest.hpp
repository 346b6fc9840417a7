#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbweaver::document {

/// Least number of inserted, deleted or exchanged characters that turn `a` into `b` (Levenshtein).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, or an empty string when none is near enough to be a slip of the pen.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// "a, b or c".
[[nodiscard]] std::string alternatives(const std::vector<std::string>& words);

}  // namespace orbweaver::document
