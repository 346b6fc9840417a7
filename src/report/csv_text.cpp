#include "csv_text.hpp"

#include <cmath>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace orbweaver::report {

namespace {

bool is_number(const std::string& text) {
  char* end = nullptr;
  static_cast<void>(std::strtod(text.c_str(), &end));
  return end == text.c_str() + text.size();
}

/// A spreadsheet takes such a text as a formula, quoted or not.
bool would_be_run(const std::string& text) {
  return !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos && !is_number(text);
}

}  // namespace

std::string csv_text(const std::string& text) {
  const bool runs = would_be_run(text);
  if (!runs && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = runs ? "\"'" : "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.17g}", value); }

}  // namespace orbweaver::report
