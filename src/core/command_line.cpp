#include "orbweaver/core/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace orbweaver::core {

std::string shell_word(const std::string& text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_./=:+,-@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string command_line(const std::vector<std::string>& words) {
  std::string line = "orbweaver";
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

}  // namespace orbweaver::core
