#pragma once

#include <string>
#include <vector>

namespace orbweaver::report {

/// The text in quotes: control characters escaped, U+FFFD for each byte that is not UTF-8.
[[nodiscard]] std::string json_text(const std::string& text);

/// All digits; `null` for what is no finite number.
[[nodiscard]] std::string json_number(double value);

/// [.., ..] of numbers or of texts, each as above.
[[nodiscard]] std::string json_list(const std::vector<double>& values);
[[nodiscard]] std::string json_list(const std::vector<std::string>& values);

}  // namespace orbweaver::report
