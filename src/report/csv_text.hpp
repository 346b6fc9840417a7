#pragma once

#include <string>

namespace orbweaver::report {

/// A field of CSV (RFC 4180): in quotes where it has a comma, a quote or the end of a line in it. A text that a
/// spreadsheet would take for a formula (it begins with =, +, -, @, a tab or a carriage return) has an apostrophe
/// before it.
[[nodiscard]] std::string csv_text(const std::string& text);

/// All digits; `nan` for what is none.
[[nodiscard]] std::string csv_number(double value);

}  // namespace orbweaver::report
