#include "json_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "orbweaver/core/text.hpp"

namespace orbweaver::report {

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{:.17g}", value) : "null"; }

std::string json_text(const std::string& text) {
  std::string quoted = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = core::character_length(text, at);
    const std::string character = text.substr(at, std::max<std::size_t>(length, 1));
    if (length == 0)
      quoted += "\\ufffd";  // no character: the one that Unicode has in place of such
    else if (character == "\"" || character == "\\")
      quoted += "\\" + character;
    else if (core::is_control(character))
      quoted += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(core::code_point(character)));  // below U+10000
    else
      quoted += character;
    at += character.size();
  }
  return quoted + '"';
}

std::string json_list(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(json_number(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string json_list(const std::vector<std::string>& values) {
  std::vector<std::string> texts;
  for (const std::string& value : values) texts.push_back(json_text(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

}  // namespace orbweaver::report
