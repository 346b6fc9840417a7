#include "csv_text.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace orbweaver::report {

std::string csv_text(const std::string& text) {
  const bool would_run = text.size() > 1 && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  if (!would_run && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = would_run ? "\"'" : "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.17g}", value); }

}  // namespace orbweaver::report
