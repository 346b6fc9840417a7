#pragma once

#include <string>

namespace orbweaver::report {

/// The text in quotes: control characters escaped, U+FFFD for each byte that is not UTF-8.
[[nodiscard]] std::string json_text(const std::string& text);

/// All digits; `null` for what is no finite number.
[[nodiscard]] std::string json_number(double value);

}  // namespace orbweaver::report
